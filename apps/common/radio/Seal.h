#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "UdpSocket.h"

namespace radio {

/** A key that two programs share. Each datagram carries a code behind it that only who has the key
 * can make (HMAC-SHA-256, of which 16 bytes travel). Without a key nothing is added, and everything
 * is taken. */
class Seal {
 public:
  Seal() = default;
  /** \param keyFile All its bytes are the key.
   * \throw std::runtime_error naming it: it cannot be read, or is shorter than 16 bytes. */
  explicit Seal(const std::filesystem::path& keyFile);

  std::string sealed(const std::string& bytes) const;
  /** What was sealed. \throw std::runtime_error with another key, with none, or altered since. */
  std::string opened(const std::string& bytes) const;

 private:
  std::string codeOf(const std::string& bytes) const;

  std::string m_key;  ///< empty: none
};

/** Numbers that prove an address: who asks under one has to show what was sent there before.
 * Nothing is kept of those who ask. */
class Cookies {
 public:
  static constexpr std::size_t kBytes = 8;

  Cookies();
  /** For a stream of a peer. */
  std::string of(const Peer& peer, std::uint32_t stream) const { return of(peer, stream, now()); }
  /** Whether it is the peer's, of the last 16 to 32 s. */
  bool isOf(const std::string& cookie, const Peer& peer, std::uint32_t stream) const {
    return cookie == of(peer, stream, now()) || cookie == of(peer, stream, now() - 1);
  }

 private:
  static std::int64_t now();
  std::string of(const Peer& peer, std::uint32_t stream, std::int64_t time) const;

  std::array<unsigned char, 16> m_secret;
};

}  // namespace radio
