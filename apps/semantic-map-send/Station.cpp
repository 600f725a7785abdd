#include "Station.h"

#include <semantic_abstraction/Abstraction.h>

#include <algorithm>
#include <ostream>

#include "StandardOutput.h"

namespace semantic_map_send {
namespace {

/** So long after all was sent, what was not acknowledged goes out again. */
constexpr std::chrono::milliseconds kPatience(500);

}  // namespace

Session::Session(const radio::Peer& peer, std::uint32_t stream, Maps& maps,
                 const semantic_octree::AbstractionOptions& options)
    : m_peer(peer), m_stream(stream), m_maps(maps), m_options(options), m_sender(stream) {
  sendNextMap();
  m_lastSent = m_lastHeard = Clock::now();
}

bool Session::accept(const Datagram& datagram) {
  if (datagram.type != Datagram::Type::Receipt && datagram.type != Datagram::Type::End)
    return false;
  const bool isNew = m_sender && (datagram.type == Datagram::Type::End || take(datagram));
  if (datagram.type == Datagram::Type::End) m_sender.reset();
  m_owesEnd = isServed();
  if (isNew) m_lastHeard = Clock::now();
  return isNew;
}

bool Session::take(const Datagram& receipt) {
  const bool isNew = m_sender->accept(receipt);
  if (!m_sender->isComplete()) return isNew;
  if (m_nextMap < m_maps.size())
    sendNextMap();
  else
    m_sender.reset();
  return isNew;
}

void Session::sendNextMap() {
  semantic_octree::SemanticOcTree& map = m_maps[m_nextMap++].tree();
  setAbstraction(map, m_options);
  m_sender->setMap(map, m_nextMap == m_maps.size());
  dropAbstraction(map);
}

std::optional<Datagram> Session::next() {
  std::optional<Datagram> datagram;
  if (std::exchange(m_owesEnd, false)) {
    datagram = {Datagram::Type::End, m_stream, ""};
  } else if (m_sender) {
    datagram = m_sender->next();
    if (!datagram && Clock::now() - m_lastSent > kPatience) {
      m_sender->repeat();
      datagram = m_sender->next();
    }
  }
  if (!datagram) return datagram;
  m_lastSent = Clock::now();
  ++m_numSent;
  m_bytesSent += datagram->bytes().size();
  return datagram;
}

namespace {

/** Bytes of the headers of IP and UDP. */
constexpr std::size_t kHeaders = 28;
/** Who does not know yet that it has all is told so, if it asks that late. */
constexpr std::chrono::milliseconds kFarewell(1000);
/** So long nothing is looked at if nobody is heard. */
constexpr std::chrono::milliseconds kTick(100);

}  // namespace

Station::Station(Maps& maps, const radio::Wish& own, const radio::Seal& seal,
                 const StationOptions& options)
    : m_maps(maps),
      m_own(own),
      m_seal(seal),
      m_options(options),
      m_socket(options.port),
      m_radio(m_socket, options.loss, options.seed),
      m_silence("nobody asked for the map at port " + std::to_string(port())),
      m_nextSending(Clock::now()),
      m_lastHeard(m_nextSending),
      m_lastBusy(m_nextSending) {}

void Station::serve(const StopRequest& stop) {
  while (!stop.pending() && !isOver()) {
    const auto wait = m_nextSending - Clock::now();
    listen(wait > wait.zero() ? wait : sendOne() ? wait.zero() : kTick);
    forgetSilent();
  }
  for (const Session& s : m_sessions)
    if (s.isServed())
      notes() << s.peer().text() << ": " << s.numSent() << " datagrams of " << s.bytesSent()
              << " bytes\n";
}

std::size_t Station::numServed() const {
  return static_cast<std::size_t>(std::count_if(m_sessions.begin(), m_sessions.end(),
                                                [](const Session& s) { return s.isServed(); }));
}

bool Station::isOver() const {
  const auto silence = Clock::now() - std::max(m_lastHeard, m_lastBusy);
  if (numServed() >= m_options.receivers) return silence > kFarewell;
  if (numServed() == m_sessions.size() && silence > Seconds(m_options.timeout))
    throw std::runtime_error(m_silence);
  return false;
}

/** Takes the next datagram, if one comes in time. */
void Station::listen(Clock::duration most) {
  radio::Peer from;
  const auto bytes = m_socket.receive(from, most);
  if (!bytes) return;
  try {
    const auto before = Clock::now();
    const bool isNew = take(from, Datagram::of(m_seal.opened(*bytes)));
    const auto now = Clock::now();
    if (isNew) m_lastHeard = now;
    if (now - before > kTick) m_lastBusy = now;
  } catch (const std::runtime_error& e) {
    details() << from.text() << ": " << e.what() << std::endl;
  }
}

/** \return whether a receiver told something new */
bool Station::take(const radio::Peer& from, const Datagram& datagram) {
  for (Session& session : m_sessions)
    if (session.isOf(from, datagram.stream)) return session.accept(datagram);
  if (datagram.type != Datagram::Type::Request) return false;
  if (m_cookies.isOf(datagram.payload.substr(0, radio::Cookies::kBytes), from, datagram.stream))
    return hasRoomFor(from) && begin(from, datagram);
  if (!m_answer)
    m_answer.emplace(from, Datagram{Datagram::Type::Cookie, datagram.stream,
                                    m_cookies.of(from, datagram.stream)});
  return false;
}

bool Station::hasRoomFor(const radio::Peer& from) const {
  std::size_t all = 0, ofAddress = 0;
  for (const Session& s : m_sessions) {
    if (s.isServed()) continue;
    ++all;
    ofAddress += s.peer().address.sin_addr.s_addr == from.address.sin_addr.s_addr;
  }
  return all < kMostAtOnce && ofAddress < kMostOfAddress;
}

bool Station::begin(const radio::Peer& from, const Datagram& request) {
  radio::Wish wish = radio::Wish::of(request.payload.substr(radio::Cookies::kBytes));
  if (wish.weights.empty()) wish.weights = m_own.weights;
  if (wish.solution.empty()) wish.solution = m_own.solution;
  try {
    const auto options = wish.forClasses(m_maps.front().tree().classes(), "weights");
    m_sessions.emplace_front(from, request.stream, m_maps, options);
    return true;
  } catch (const std::exception& e) {
    const std::string why = std::string(e.what()).substr(0, semantic_octree::kMaxDatagramBytes / 2);
    notes() << from.text() << ": refused: " << why << std::endl;
    m_answer.emplace(from, Datagram{Datagram::Type::Refusal, request.stream, why});
    return false;
  }
}

/** Receivers take turns, and so do they and those who ask. \return whether there was anything */
bool Station::sendOne() {
  m_hasAnswered = m_answer && !m_hasAnswered;
  if (m_hasAnswered) {
    send(m_answer->first, m_answer->second);
    m_answer.reset();
    return true;
  }
  for (auto s = m_sessions.begin(); s != m_sessions.end(); ++s)
    if (const auto datagram = s->next()) {
      send(s->peer(), *datagram);
      m_sessions.splice(m_sessions.end(), m_sessions, s);
      return true;
    }
  return m_answer.has_value();
}

void Station::send(const radio::Peer& to, const Datagram& datagram) {
  const std::string bytes = m_seal.sealed(datagram.bytes());
  m_radio.send(to, bytes);
  const double bits = 8.0 * static_cast<double>(bytes.size() + kHeaders);
  m_nextSending = std::max(m_nextSending, Clock::now() - kTick) +
                  std::chrono::duration_cast<Clock::duration>(
                      Seconds(m_options.rate > 0 ? bits / m_options.rate : 0));
}

void Station::forgetSilent() {
  const auto since = Clock::now() - std::chrono::duration_cast<Clock::duration>(
                                        Seconds(std::min(m_options.timeout, 1e9)));
  if (m_lastBusy > since) return;
  m_sessions.remove_if([&](const Session& s) {
    if (s.isServed() || s.lastHeard() > since) return false;
    m_silence = "the receiver " + s.peer().text() + " fell silent";
    notes() << m_silence << std::endl;
    m_lastHeard = Clock::now();  // now there is room for who was asking in vain
    return true;
  });
}

}  // namespace semantic_map_send
