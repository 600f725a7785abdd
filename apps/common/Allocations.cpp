// Allocations of this program and of all libraries in it: symbols of a program are found before
// those of libraries. MRPT makes room for as much as a rawlog says it holds before it reads it, and
// can be stopped nowhere else. Two rawlogs of test/fuzz/corpus/rawlog/ show it. Without what stands
// here, rawlog2semantic-map ends by a segmentation fault over depth_image_beyond_memory (274
// bytes). Over velodyne_calibration_beyond_memory (217 bytes) it takes 17 GB and more than a
// minute. With it both are refused within a second.
//
// Likewise libjpeg's handler of errors, with which MRPT reads images of rawlogs: it ends the
// program, as image_of_a_bad_table there shows (5.8 kB).
#include <dlfcn.h>
#include <strict_files/Memory.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>

#include <jpeglib.h>

using strict_files::AllocationLimit;
using strict_files::PieceTooLarge;

namespace mrpt {

void* aligned_malloc(std::size_t bytes, std::size_t alignment);

/** Replaces MRPT's own, whose matrices and depth images write to whatever it returns. If a damaged
 * file asks for more than there is, MRPT's returns null; if for less, gigabytes of zeros.
 * \throw std::bad_alloc there is no memory; PieceTooLarge: it is more than any image
 * takes, or the file has */
void* aligned_malloc(std::size_t bytes, std::size_t alignment) {
  // 16384 x 16384 distances
  if (bytes > AllocationLimit::kMost || !AllocationLimit::isAllowed(bytes)) throw PieceTooLarge();
  // aligned_alloc() is defined for multiples of the alignment.
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, whole);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace mrpt

// The standard library's other forms call these, but for large alignments. The address
// sanitizer has its own of these, whose memory is freed here: alloc_dealloc_mismatch=0. Not inline:
// or the compiler pairs malloc() here with delete there, and warns.
#define NOT_INLINE __attribute__((noinline))
NOT_INLINE void* operator new(std::size_t size) {
  if (!AllocationLimit::isAllowed(size)) throw PieceTooLarge();
  void* const memory = std::malloc(size ? size : 1);
  if (!memory) throw std::bad_alloc();
  return memory;
}
NOT_INLINE void operator delete(void* memory) noexcept { std::free(memory); }
NOT_INLINE void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

/** Replaces libjpeg's, whose errors end the process. OpenCV's errors are its own.
 * \throw std::runtime_error not here: where there is an error in an image */
jpeg_error_mgr* jpeg_std_error(jpeg_error_mgr* errors) {
  static const auto usual =
      reinterpret_cast<decltype(&jpeg_std_error)>(dlsym(RTLD_NEXT, "jpeg_std_error"));
  usual(errors)->error_exit = [](j_common_ptr image) {
    char what[JMSG_LENGTH_MAX];
    image->err->format_message(image, what);
    if (image->mem) image->mem->self_destruct(image);
    throw std::runtime_error(std::string("a JPEG: ") + what);
  };
  return errors;
}
