#include "Lzf.h"

#include <stdexcept>

#ifdef MSO_WITH_LZF
#include <lzf.h>
#endif

namespace labeled_cloud {

#ifdef MSO_WITH_LZF

std::string decompressLzf(std::string_view data, std::size_t size, const std::string& name) {
  constexpr std::size_t kMostPerByte = 88;  // three bytes repeat at most 264
  std::string bytes(size <= data.size() * kMostPerByte ? size : 0, '\0');
  if (bytes.size() != size || lzf_decompress(data.data(), static_cast<unsigned int>(data.size()),
                                             bytes.data(), static_cast<unsigned int>(size)) != size)
    throw std::runtime_error(name + ": " + std::to_string(data.size()) +
                             " bytes of compressed data do not become the " + std::to_string(size) +
                             " that were announced");
  return bytes;
}

#else

std::string decompressLzf(std::string_view, std::size_t, const std::string& name) {
  throw std::runtime_error(name +
                           ": compressed, and this was built without liblzf; write it as"
                           " DATA binary");
}

#endif

}  // namespace labeled_cloud
