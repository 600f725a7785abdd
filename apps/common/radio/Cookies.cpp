#include "Cookies.h"

#include <sodium.h>

namespace radio {

static_assert(Cookies::kBytes == crypto_shorthash_BYTES);

Cookies::Cookies() { randombytes_buf(m_secret.data(), m_secret.size()); }

std::int64_t Cookies::now() {
  constexpr std::chrono::seconds kLife(16);
  return std::chrono::steady_clock::now().time_since_epoch() / kLife;
}

std::string Cookies::of(const Peer& peer, std::uint32_t stream, std::int64_t time) const {
  const std::string text = peer.text() + ' ' + std::to_string(stream) + ' ' + std::to_string(time);
  std::string cookie(kBytes, '\0');
  crypto_shorthash(reinterpret_cast<unsigned char*>(&cookie[0]),
                   reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                   m_secret.data());
  return cookie;
}

}  // namespace radio
