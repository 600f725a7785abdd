#pragma once
#include <strict_files/AllocationLimit.h>

#include <exception>
#include <new>
#include <string>
#include <system_error>

namespace strict_files {

/** What an exception says, without the call stack that MRPT appends to the text of its own, and
 * without those of the exceptions that it was passed on as. */
inline std::string messageOf(const std::exception& e) {
  if (dynamic_cast<const PieceTooLarge*>(&e)) return e.what();
  if (dynamic_cast<const std::bad_alloc*>(&e)) return "more memory is needed than there is";
  if (const auto* error = dynamic_cast<const std::system_error*>(&e);
      error && error->code() == std::errc::resource_unavailable_try_again)
    return "no further thread can be begun: memory, or the number of processes, is at its limit";
  const std::string text = e.what(), begin = "Message:  ", end = "\nLocation:";
  const std::size_t from = text.rfind(begin);
  if (from == std::string::npos) return text;
  const std::size_t start = from + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

}  // namespace strict_files
