#include "Seal.h"

#include <sodium.h>
#include <strict_files/TextFile.h>

#include <stdexcept>

namespace radio {
namespace {

/** Bytes of a code, and of the shortest key. */
constexpr std::size_t kCode = 16, kShortestKey = 16;

}  // namespace

Seal::Seal(const std::filesystem::path& keyFile) : m_key(strict_files::readText(keyFile)) {
  if (m_key.size() < kShortestKey)
    throw std::runtime_error(keyFile.string() + ": a key of " + std::to_string(m_key.size()) +
                             " bytes, expected 16 at least");
}

std::string Seal::codeOf(const std::string& bytes) const {
  const auto data = [](const std::string& text) {
    return reinterpret_cast<const unsigned char*>(text.data());
  };
  unsigned char code[crypto_auth_hmacsha256_BYTES];
  crypto_auth_hmacsha256_state state;
  crypto_auth_hmacsha256_init(&state, data(m_key), m_key.size());
  crypto_auth_hmacsha256_update(&state, data(bytes), bytes.size());
  crypto_auth_hmacsha256_final(&state, code);
  return {reinterpret_cast<const char*>(code), kCode};
}

std::string Seal::sealed(const std::string& bytes) const {
  return m_key.empty() ? bytes : bytes + codeOf(bytes);
}

std::string Seal::opened(const std::string& bytes) const {
  if (m_key.empty()) return bytes;
  const std::string inner = bytes.substr(0, bytes.size() - std::min(bytes.size(), kCode));
  const std::string code = codeOf(inner);
  if (bytes.size() < kCode || sodium_memcmp(&bytes[inner.size()], code.data(), kCode) != 0)
    throw std::runtime_error("a datagram without the code of this key");
  return inner;
}

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
