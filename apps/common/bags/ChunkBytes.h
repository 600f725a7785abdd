#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace bags {

/** Bytes of a chunk that is larger are refused. */
constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 30;

/** What was compressed; memory grows with what comes out, not with what is announced.
 * \param compression "" (it was not), "zstd" or "lz4" \param size as announced
 * \throw std::runtime_error it is another compression, damaged, or of another size. */
std::string uncompressed(std::string_view bytes, std::string_view compression, std::uint64_t size);

}  // namespace bags
