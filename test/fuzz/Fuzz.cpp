// libFuzzer's entry point: MSO_READER names the reader that gets the bytes.
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "Readers.h"

namespace {

const Reader& chosen() {
  const char* name = std::getenv("MSO_READER");
  for (const Reader& reader : readers())
    if (name && reader.name == name) return reader;
  std::cerr << "MSO_READER must be one of";
  for (const Reader& reader : readers()) std::cerr << ' ' << reader.name;
  std::cerr << '\n';
  std::exit(64);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Reader& reader = chosen();
  try {
    reader.read({reinterpret_cast<const char*>(data), size});
  } catch (const std::exception&) {
  }
  return 0;
}
