#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <new>

namespace strict_files {

/** A piece of memory is refused for its size, however much there is. */
class PieceTooLarge : public std::bad_alloc {
 public:
  const char* what() const noexcept override {
    return "more memory is asked for than the file is worth, as a damaged one makes it";
  }
};

/** While one lives, its thread gets only memory that it allows, and no piece of more than 1 GiB.
 * Programs' operator new asks isAllowed() for that, as in this project. For what others read from
 * files that may be damaged: they make room for as many elements as a file says it has. One at a
 * time. */
class AllocationLimit {
 public:
  static constexpr std::size_t kMost = std::size_t{1} << 30;  ///< bytes
  using Allows = std::function<bool(std::size_t)>;            ///< may take memory itself

  /** \param allows outlives this */
  explicit AllocationLimit(Allows& allows) { current() = &allows; }
  ~AllocationLimit() { current() = nullptr; }
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;

  static bool isAllowed(std::size_t bytes);

 private:
  /** In this thread. */
  static Allows*& current();
};

/** Bytes of memory that this process could still take: what the system has left, and no more than
 * the limit on its addresses (`ulimit -v`). Without /proc/meminfo only the latter counts. */
std::uint64_t availableMemory();

}  // namespace strict_files
