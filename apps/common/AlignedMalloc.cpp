#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace mrpt {

void* aligned_malloc(std::size_t bytes, std::size_t alignment);

/** Replaces MRPT's own in programs (symbols of a program are found before those of libraries):
 * matrices and depth images take it for an allocator and write to what it returns, which there is
 * null if a damaged file asks for more than there is. \throw std::bad_alloc there is no memory. */
void* aligned_malloc(std::size_t bytes, std::size_t alignment) {
  void* const memory = bytes <= PTRDIFF_MAX ? std::aligned_alloc(alignment, bytes) : nullptr;
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace mrpt
