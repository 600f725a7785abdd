#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace semantic_octree {

/** Memory of elements of one size that are known by 32-bit numbers. Elements stay where they are;
 * one thread may use them while another asks for more. All is given back when the pool goes. */
class IndexPool {
 public:
  /** \param stride bytes of an element */
  explicit IndexPool(std::size_t stride) : m_stride(stride) {}

  std::byte* at(std::uint32_t index) const {
    return m_directory.load(std::memory_order_acquire)[index >> kChunkBits] +
           (index & (kPerChunk - 1)) * m_stride;
  }
  std::size_t stride() const { return m_stride; }

  /** Adds kPerChunk elements. \return the first one's number \throw std::bad_alloc */
  std::uint32_t addChunk();

  static constexpr std::uint32_t kPerChunk = 1024;

 private:
  static constexpr int kChunkBits = 10;
  static_assert(kPerChunk == 1u << kChunkBits);
  using Directory = std::unique_ptr<std::byte*[]>;

  std::size_t m_stride;
  std::mutex m_mutex;
  std::vector<std::unique_ptr<std::byte[]>> m_chunks;
  /** The chunks' addresses. When they do not fit any more a larger one follows; those before stay,
   * because somebody may be reading them. */
  std::vector<Directory> m_directories;
  std::size_t m_capacity = 0;
  std::atomic<std::byte**> m_directory{nullptr};
};

/** One thread's way to take elements of a pool, and to give them back: runs of up to 64 behind each
 * other. Runs of a few lengths are given out; a run of n elements is one of the next length. */
class IndexAllocator {
 public:
  std::uint32_t allocate(IndexPool& pool, int n = 1);
  void release(std::uint32_t index, int n = 1);
  /** Elements taken less given back; an allocator may be given what another has taken. A run counts
   * with all elements of its length. */
  long inUse() const { return m_inUse; }
  /** Single elements given back and not taken again. */
  std::size_t spare() const { return m_free[0].size(); }
  /** Whether a run of n elements would do for m as well, and no shorter one. */
  static bool sameLength(int n, int m) { return lengthClass(n) == lengthClass(m); }

 private:
  static constexpr int kLengths[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
  static constexpr int kNumLengths = 12;
  static int lengthClass(int n);

  std::vector<std::uint32_t> m_free[kNumLengths];
  std::uint32_t m_next = 0, m_left = 0;
  long m_inUse = 0;
};

}  // namespace semantic_octree
