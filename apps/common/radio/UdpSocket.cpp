#include "UdpSocket.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace radio {
namespace {

/** Datagrams are not longer; what is, is none of ours, and cut off. */
constexpr std::size_t kMaxBytes = 2048;

timespec timespecOf(std::chrono::nanoseconds time) {
  constexpr long kSecond = 1'000'000'000;
  const auto whole = std::max<std::chrono::nanoseconds::rep>(time.count(), 0);
  return {whole / kSecond, whole % kSecond};
}

}  // namespace

Peer Peer::of(const std::string& host, int port) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0 || !found)
    throw std::runtime_error("host '" + host + "' is not known");
  Peer peer;
  std::memcpy(&peer.address, found->ai_addr, sizeof(peer.address));
  freeaddrinfo(found);
  peer.address.sin_port = htons(static_cast<std::uint16_t>(port));
  return peer;
}

std::string Peer::text() const {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &address.sin_addr, text, sizeof(text));
  return std::string(text) + ":" + std::to_string(ntohs(address.sin_port));
}

UdpSocket::UdpSocket(int port) : m_descriptor(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(INADDR_ANY);
  own.sin_port = htons(static_cast<std::uint16_t>(port));
  if (m_descriptor >= 0 && bind(m_descriptor, reinterpret_cast<sockaddr*>(&own), sizeof(own)) == 0)
    return;
  const std::string reason = std::strerror(errno);
  if (m_descriptor >= 0) close(m_descriptor);
  throw std::runtime_error("port " + std::to_string(port) + " cannot be used: " + reason);
}

UdpSocket::~UdpSocket() { close(m_descriptor); }

int UdpSocket::port() const {
  sockaddr_in own{};
  socklen_t size = sizeof(own);
  getsockname(m_descriptor, reinterpret_cast<sockaddr*>(&own), &size);
  return ntohs(own.sin_port);
}

void UdpSocket::send(const Peer& to, const std::string& bytes) {
  sendto(m_descriptor, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&to.address), sizeof(to.address));
}

std::optional<std::string> UdpSocket::receive(Peer& from, std::chrono::nanoseconds timeout) {
  pollfd wait{m_descriptor, POLLIN, 0};
  const timespec most = timespecOf(timeout);
  if (ppoll(&wait, 1, &most, nullptr) <= 0) return std::nullopt;
  std::string bytes(kMaxBytes, '\0');
  socklen_t size = sizeof(from.address);
  const ssize_t received = recvfrom(m_descriptor, &bytes[0], bytes.size(), MSG_DONTWAIT,
                                    reinterpret_cast<sockaddr*>(&from.address), &size);
  if (received < 0) return std::nullopt;
  bytes.resize(static_cast<std::size_t>(received));
  return bytes;
}

namespace {

constexpr double kTwice = 0.1, kLate = 0.25;

}  // namespace

bool BadRadio::chance(double p) { return static_cast<double>(m_random()) < p * 4294967296.0; }

void BadRadio::send(const Peer& to, const std::string& bytes) {
  if (m_loss == 0) return m_socket.send(to, bytes);
  if (chance(m_loss)) return;
  if (!m_late && chance(kLate)) {
    m_late.emplace(to, bytes);
    return;
  }
  m_socket.send(to, bytes);
  if (chance(kTwice)) m_socket.send(to, bytes);
  if (m_late) m_socket.send(m_late->first, m_late->second);
  m_late.reset();
}

}  // namespace radio
