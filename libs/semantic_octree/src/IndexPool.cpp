#include <semantic_octree/store/IndexPool.h>

#include <algorithm>
#include <new>

namespace semantic_octree {

std::uint32_t IndexPool::addChunk() {
  const std::lock_guard<std::mutex> lock(m_mutex);
  const std::size_t n = m_chunks.size();
  if (n > UINT32_MAX / kPerChunk - 1) throw std::bad_alloc();
  if (n == m_capacity) {
    const std::size_t capacity = std::max<std::size_t>(16, 2 * m_capacity);
    m_directories.reserve(m_directories.size() + 1);
    Directory directory(new std::byte*[capacity]);
    std::copy_n(m_directory.load(std::memory_order_relaxed), n, directory.get());
    m_directory.store(directory.get(), std::memory_order_release);
    m_directories.push_back(std::move(directory));
    m_capacity = capacity;
  }
  m_chunks.emplace_back(new std::byte[kPerChunk * m_stride]);
  m_directory.load(std::memory_order_relaxed)[n] = m_chunks.back().get();
  return static_cast<std::uint32_t>(n * kPerChunk);
}

int IndexAllocator::lengthClass(int n) {
  int c = 0;  // single elements are the most frequent
  while (kLengths[c] < n) ++c;
  return c;
}

std::uint32_t IndexAllocator::allocate(IndexPool& pool, int n) {
  const int c = lengthClass(n);
  const auto length = static_cast<std::uint32_t>(kLengths[c]);
  if (m_free[c].empty() && m_left < length) {
    m_next = pool.addChunk();
    m_left = IndexPool::kPerChunk;
  }
  m_inUse += kLengths[c];
  if (m_free[c].empty()) {
    m_left -= length;
    m_next += length;
    return m_next - length;
  }
  const std::uint32_t index = m_free[c].back();
  m_free[c].pop_back();
  return index;
}

void IndexAllocator::release(std::uint32_t index, int n) {
  const int c = lengthClass(n);
  m_free[c].push_back(index);
  m_inUse -= kLengths[c];
}

}  // namespace semantic_octree
