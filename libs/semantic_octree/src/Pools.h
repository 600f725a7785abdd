#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

namespace semantic_octree {

/** Zeroed blocks of T (trivially copyable memory) at fixed addresses, with one free list per arena
 * so that threads do not meet. Memory is given back when the pool goes. */
template <typename T>
class BlockPool {
 public:
  class Arena {
   public:
    explicit Arena(BlockPool& pool) : m_pool(pool) {}
    T* allocate() {
      void* block = m_free;
      if (block)
        std::memcpy(&m_free, block, sizeof(void*));
      else
        block = m_next == m_end ? startChunk() : m_next++;
      return static_cast<T*>(std::memset(block, 0, sizeof(T)));
    }
    void release(T* block) {
      std::memcpy(static_cast<void*>(block), &m_free, sizeof(void*));
      m_free = block;
    }

   private:
    T* startChunk() {
      m_next = m_pool.newChunk();
      m_end = m_next + kBlocksPerChunk;
      return m_next++;
    }
    BlockPool& m_pool;
    void* m_free = nullptr;
    T *m_next = nullptr, *m_end = nullptr;
  };

  std::size_t bytes() const { return m_chunks.size() * kBlocksPerChunk * sizeof(T); }

 private:
  static constexpr std::size_t kBlocksPerChunk = 512;
  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  T* newChunk() {
    void* chunk = std::malloc(kBlocksPerChunk * sizeof(T));
    if (!chunk) throw std::bad_alloc();
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_chunks.emplace_back(chunk);
    return static_cast<T*>(chunk);
  }
  std::mutex m_mutex;
  std::vector<std::unique_ptr<void, Free>> m_chunks;
};

/** Records of `stride` bytes known by a 32-bit index; 0 is none. The directory of chunks never
 * moves, so that one thread can read while another adds a chunk. */
class RecordPool {
 public:
  explicit RecordPool(std::size_t stride)
      : m_stride(stride),
        m_directory(static_cast<std::byte**>(std::calloc(kMaxChunks, sizeof(void*)))) {
    if (!m_directory) throw std::bad_alloc();
  }
  ~RecordPool() {
    for (std::size_t i = 0; i < m_numChunks; ++i) std::free(m_directory[i]);
    std::free(m_directory);
  }
  RecordPool(const RecordPool&) = delete;
  RecordPool& operator=(const RecordPool&) = delete;

  template <typename T>
  T* at(std::uint32_t index) const {
    return reinterpret_cast<T*>(m_directory[index >> kChunkBits] + (index & kChunkMask) * m_stride);
  }
  std::size_t bytes() const { return m_numChunks * kRecordsPerChunk * m_stride; }

  class Arena {
   public:
    explicit Arena(RecordPool& pool) : m_pool(pool) {}
    std::uint32_t allocate() {
      if (!m_free.empty()) {
        const std::uint32_t index = m_free.back();
        m_free.pop_back();
        return index;
      }
      if (m_next == m_end) {
        m_next = m_pool.newChunk();
        m_end = m_next + kRecordsPerChunk;
        if (m_next == 0) ++m_next;  // index 0 means none
      }
      return m_next++;
    }
    void release(std::uint32_t index) { m_free.push_back(index); }

   private:
    RecordPool& m_pool;
    std::vector<std::uint32_t> m_free;
    std::uint64_t m_next = 0, m_end = 0;
  };

 private:
  static constexpr int kChunkBits = 12;
  static constexpr std::uint32_t kChunkMask = (1u << kChunkBits) - 1;
  static constexpr std::size_t kRecordsPerChunk = std::size_t(1) << kChunkBits;
  static constexpr std::size_t kMaxChunks = std::size_t(1) << (32 - kChunkBits);

  std::uint64_t newChunk() {
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (m_numChunks == kMaxChunks) throw std::bad_alloc();
    auto* chunk = static_cast<std::byte*>(std::malloc(kRecordsPerChunk * m_stride));
    if (!chunk) throw std::bad_alloc();
    m_directory[m_numChunks] = chunk;
    return static_cast<std::uint64_t>(m_numChunks++) << kChunkBits;
  }

  std::size_t m_stride;
  std::byte** m_directory;
  std::size_t m_numChunks = 0;
  std::mutex m_mutex;
};

}  // namespace semantic_octree
