#include "Radio.h"

#include <arpa/inet.h>
#include <map_streams/MapStream.h>
#include <netdb.h>
#include <poll.h>
#include <sodium.h>
#include <strict_files/TextFile.h>
#include <sys/socket.h>
#include <unistd.h>
#include <zlib.h>
#include <nlohmann/json.hpp>

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

namespace {

/** Bytes of a wish, compressed: what a datagram's header and the cookie leave; and as it is. */
constexpr std::size_t kMaxPacked = semantic_octree::kMaxDatagramBytes - 12 - Cookies::kBytes,
                      kMaxText = 1 << 16;

}  // namespace

semantic_octree::AbstractionOptions Wish::forClasses(const semantic_types::ClassTable& classes,
                                                     const std::string& name) const {
  if (weights.empty())
    throw std::runtime_error("no weights: neither the sender nor the receiver has --weights");
  auto options = semantic_octree::solutionIn(
      semantic_octree::weightsOfText(weights, name, classes, 0), solution, name);
  // The terms of semantic-map-compress, in its order: rounding decides no tie otherwise.
  options.weights.terms = semantic_octree::TermCatalog(classes, {options}).terms(options);
  if (alpha) options.weights.alpha = *alpha;
  return options;
}

std::string Wish::packed() const {
  nlohmann::json json = {{"weights", weights}, {"solution", solution}};
  if (alpha) json["alpha"] = *alpha;
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  uLongf size = compressBound(text.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(&packed[0]), &size,
            reinterpret_cast<const Bytef*>(text.data()), text.size(), Z_BEST_COMPRESSION);
  packed.resize(size);
  if (text.size() > kMaxText || packed.size() > kMaxPacked)
    throw std::runtime_error("weights of " + std::to_string(weights.size()) +
                             " bytes are too long to be sent: they have to fit into " +
                             std::to_string(kMaxPacked) +
                             " compressed, or to be the sender's own (--weights)");
  return packed;
}

Wish Wish::of(const std::string& packed) {
  const auto check = [](bool isSo) {
    if (!isSo) throw std::runtime_error("altered: a request that cannot be");
  };
  std::string text(kMaxText, '\0');
  uLongf size = text.size();
  check(uncompress(reinterpret_cast<Bytef*>(&text[0]), &size,
                   reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  text.resize(size);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const auto isText = [&json](const char* key) {
    return json.contains(key) && json[key].is_string();
  };
  check(json.is_object() && isText("weights") && isText("solution"));
  Wish wish{json["weights"], json["solution"], std::nullopt};
  if (json.contains("alpha") && json["alpha"].is_number()) wish.alpha = json["alpha"];
  return wish;
}

}  // namespace radio
