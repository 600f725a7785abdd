#pragma once
#include <netinet/in.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace radio {

/** Where datagrams come from, or go to: an IPv4 address and a port. */
struct Peer {
  sockaddr_in address{};

  /** \throw std::runtime_error naming the host, if nobody knows it. */
  static Peer of(const std::string& host, int port);
  /** "127.0.0.1:4217" */
  std::string text() const;
  bool operator==(const Peer& o) const {
    return address.sin_addr.s_addr == o.address.sin_addr.s_addr &&
           address.sin_port == o.address.sin_port;
  }
};

class UdpSocket {
 public:
  /** \param port 0: any that is free
   * \throw std::runtime_error naming the port, if it is in use. */
  explicit UdpSocket(int port);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int port() const;
  /** What cannot be sent is lost, as on a radio. */
  void send(const Peer& to, const std::string& bytes);
  /** The next datagram; none: none came in time, or nobody listens where the last one went. */
  std::optional<std::string> receive(Peer& from, std::chrono::nanoseconds timeout);

 private:
  int m_descriptor;
};

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

/** What a receiver asks for: how much which class matters to it. */
struct Wish {
  std::string weights;          ///< text of a file of weights; empty: the sender's own
  std::string solution;         ///< its name; empty: the first
  std::optional<double> alpha;  ///< instead of the solution's

  /** What it keeps of a map of these classes. Without an alpha, all of the map.
   * \param name what messages call the weights
   * \throw std::runtime_error naming them: as semantic_octree::loadWeights(), or there is no such
   * solution, or there are none at all. */
  semantic_octree::AbstractionOptions forClasses(const semantic_types::ClassTable& classes,
                                                 const std::string& name) const;
  /** For a request, which is one datagram: with a cookie before it. \throw std::runtime_error too
   * long. */
  std::string packed() const;
  /** \throw std::runtime_error altered. */
  static Wish of(const std::string& packed);
};

}  // namespace radio
