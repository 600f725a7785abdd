#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "UdpSocket.h"

namespace radio {

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
