#include "ChunkBytes.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace bags {
namespace {

[[noreturn]] void failAs(std::string_view compression, const char* what) {
  throw std::runtime_error("a chunk compressed by " + std::string(compression) +
                           " is damaged: " + what);
}

struct Zstd {
  static constexpr std::string_view kName = "zstd";
  std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream{ZSTD_createDStream(),
                                                                       &ZSTD_freeDStream};
  void step(std::string_view& in, char* out, std::size_t& space) const {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, space, 0};
    const std::size_t result = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(result)) failAs(kName, ZSTD_getErrorName(result));
    in.remove_prefix(input.pos);
    space = output.pos;
  }
};

struct Lz4 {
  static constexpr std::string_view kName = "lz4";
  LZ4F_dctx* context = nullptr;

  Lz4() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
      throw std::bad_alloc();
  }
  ~Lz4() { LZ4F_freeDecompressionContext(context); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;
  void step(std::string_view& in, char* out, std::size_t& space) const {
    std::size_t taken = in.size();
    const std::size_t result = LZ4F_decompress(context, out, &space, in.data(), &taken, nullptr);
    if (LZ4F_isError(result)) failAs(kName, LZ4F_getErrorName(result));
    in.remove_prefix(taken);
  }
};

template <class Method>
std::string decompressed(std::string_view in, std::uint64_t size) {
  constexpr std::size_t kStep = 1 << 20;
  const Method method;
  std::string out;
  while (true) {
    const std::size_t begin = out.size(), left = in.size();
    std::size_t space = std::min<std::uint64_t>(kStep, size - begin + 1);  // one more is an error
    out.resize(begin + space);
    method.step(in, out.data() + begin, space);
    out.resize(begin + space);
    if (out.size() > size) failAs(Method::kName, "it is larger than announced");
    if (space == 0 && (in.empty() || in.size() == left)) break;
  }
  if (out.size() != size || !in.empty()) failAs(Method::kName, "it is not of the announced size");
  return out;
}

}  // namespace

std::string uncompressed(std::string_view bytes, std::string_view compression, std::uint64_t size) {
  if (size > kMostChunkBytes)
    throw std::runtime_error("a chunk of " + std::to_string(size) + " bytes, expected at most " +
                             std::to_string(kMostChunkBytes));
  if (compression == Zstd::kName) return decompressed<Zstd>(bytes, size);
  if (compression == Lz4::kName) return decompressed<Lz4>(bytes, size);
  if (!compression.empty())
    throw std::runtime_error("a chunk is compressed by '" + std::string(compression) +
                             "', expected zstd or lz4");
  if (bytes.size() != size) throw std::runtime_error("a chunk is not of the announced size");
  return std::string(bytes);
}

}  // namespace bags
