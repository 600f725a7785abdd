#pragma once
#include <cstddef>
#include <cstdint>
#include <new>

namespace strict_files {

/** A single piece of memory is refused for its size, however much there is. */
class PieceTooLarge : public std::bad_alloc {
 public:
  const char* what() const noexcept override {
    return "more than 1 GiB of memory is asked for at once, as a damaged file makes it";
  }
};

/** While one lives, its thread gets no single piece of memory of more than 1 GiB, in programs whose
 * operator new asks isAllowed(), as those of this project do. For what others read from files that
 * may be damaged: they make room for as many elements as a file says it has. */
class AllocationLimit {
 public:
  static constexpr std::size_t kMost = std::size_t{1} << 30;  ///< bytes

  AllocationLimit() { ++living(); }
  ~AllocationLimit() { --living(); }
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;

  static bool isAllowed(std::size_t bytes) { return bytes <= kMost || living() == 0; }

 private:
  /** In this thread. */
  static int& living();
};

/** Bytes of memory that this process could still take: what the system has left, and no more than
 * the limit on its addresses (`ulimit -v`). Without /proc/meminfo only the latter counts. */
std::uint64_t availableMemory();

}  // namespace strict_files
