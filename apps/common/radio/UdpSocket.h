#pragma once
#include <netinet/in.h>

#include <chrono>
#include <cstdint>
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

}  // namespace radio
