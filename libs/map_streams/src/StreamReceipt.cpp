#include "StreamReceipt.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace semantic_octree {
namespace {

constexpr std::size_t kMaxBehind = 900;  // bytes
constexpr std::size_t kFixedBytes = 10;

}  // namespace

StreamReceipt StreamReceipt::of(std::uint16_t revision, std::uint32_t sequence,
                                const std::vector<bool>& came, std::uint32_t prefix) {
  StreamReceipt r;
  r.revision = revision;
  r.sequence = sequence;
  r.prefix = prefix;
  const std::size_t end = std::min(came.size(), prefix + 8 * kMaxBehind);
  r.behind.assign((end - prefix + 7) / 8, '\0');
  for (std::size_t i = prefix; i < end; ++i)
    if (came[i]) r.behind[(i - prefix) / 8] |= static_cast<char>(1 << (i - prefix) % 8);
  while (!r.behind.empty() && r.behind.back() == 0) r.behind.pop_back();
  return r;
}

std::string StreamReceipt::bytes() const {
  std::string bytes(kFixedBytes, '\0');
  std::memcpy(&bytes[0], &revision, 2);
  std::memcpy(&bytes[2], &sequence, 4);
  std::memcpy(&bytes[6], &prefix, 4);
  return bytes + behind;
}

StreamReceipt StreamReceipt::of(const std::string& bytes) {
  if (bytes.size() < kFixedBytes) throw std::runtime_error("altered: a receipt too short");
  StreamReceipt r;
  std::memcpy(&r.revision, &bytes[0], 2);
  std::memcpy(&r.sequence, &bytes[2], 4);
  std::memcpy(&r.prefix, &bytes[6], 4);
  r.behind = bytes.substr(kFixedBytes);
  return r;
}

}  // namespace semantic_octree
