#pragma once
#include <netinet/in.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>
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

/** A socket of UDP. */
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

/** Loses a share of what is sent; a tenth of the rest is sent twice, and every fourth changes its
 * place with the next. With the same seed always the same ones. */
class BadRadio {
 public:
  /** \param loss 0: a good radio */
  BadRadio(UdpSocket& socket, double loss, unsigned seed)
      : m_socket(socket), m_random(seed), m_loss(loss) {}
  void send(const Peer& to, const std::string& bytes);

 private:
  bool chance(double p);

  UdpSocket& m_socket;
  std::mt19937 m_random;
  double m_loss;
  std::optional<std::pair<Peer, std::string>> m_late;
};

}  // namespace radio
