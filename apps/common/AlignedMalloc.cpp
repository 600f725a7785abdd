#include <cstddef>
#include <cstdlib>
#include <new>

namespace mrpt {

void* aligned_malloc(std::size_t bytes, std::size_t alignment);

/** Replaces MRPT's own in programs (symbols of a program are found before those of libraries):
 * matrices and depth images take it for an allocator and write to what it returns, which there is
 * null if a damaged file asks for more than there is, and zeros for gigabytes if for less.
 * \throw std::bad_alloc there is no memory, or it is more than any image takes */
void* aligned_malloc(std::size_t bytes, std::size_t alignment) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // 16384 x 16384 distances
  if (bytes > kMost) throw std::bad_alloc();
  // aligned_alloc() is defined for multiples of the alignment.
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, whole);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace mrpt
