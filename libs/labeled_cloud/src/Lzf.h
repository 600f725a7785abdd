#pragma once
#include <string>
#include <string_view>

namespace labeled_cloud {

/** LZF as in liblzf. \param size bytes of the result \param name the file's, for errors
 * \throw std::runtime_error naming the file: the data is damaged or becomes more or less, its size
 * is none that such data can have, or this library was built without liblzf. */
std::string decompressLzf(std::string_view data, std::size_t size, const std::string& name);

}  // namespace labeled_cloud
