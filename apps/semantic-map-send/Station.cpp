#include "Station.h"

#include <algorithm>
#include <ostream>

#include "StandardOutput.h"

namespace semantic_map_send {
namespace {

/** Bytes of the headers of IP and UDP. */
constexpr std::size_t kHeaders = 28;
/** Who does not know yet that it has all is told so, if it asks that late. */
constexpr std::chrono::milliseconds kFarewell(1000), kTick(20);

}  // namespace

Station::Station(Maps& maps, const radio::Wish& own, const StationOptions& options)
    : m_maps(maps),
      m_own(own),
      m_options(options),
      m_socket(options.port),
      m_radio(m_socket, options.loss, options.seed),
      m_begin(Clock::now()),
      m_nextSending(m_begin),
      m_lastHeard(m_begin) {}

void Station::serve(const StopRequest& stop) {
  while (!stop.pending()) {
    const bool isEnough = numServed() >= m_options.receivers;
    if (isEnough && Clock::now() - m_lastHeard > kFarewell) break;
    listen();
    sendOne();
    if (!isEnough) checkSilence();
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

/** Takes what comes until it is time to send. */
void Station::listen() {
  using std::chrono::milliseconds;
  const auto wait = std::chrono::duration_cast<milliseconds>(m_nextSending - Clock::now());
  radio::Peer from;
  auto bytes = m_socket.receive(from, std::clamp(wait, milliseconds(0), kTick));
  for (; bytes; bytes = m_socket.receive(from, milliseconds(0))) {
    try {
      const Datagram datagram = Datagram::of(*bytes);
      Session& session = sessionOf(from, datagram.stream);
      const bool wasDone = session.isDone();
      session.accept(datagram);
      m_lastHeard = Clock::now();
      if (!wasDone && !session.refusal().empty())
        notes() << from.text() << ": refused: " << session.refusal() << std::endl;
    } catch (const std::runtime_error& e) {
      details() << from.text() << ": " << e.what() << std::endl;
    }
  }
}

Session& Station::sessionOf(const radio::Peer& peer, std::uint32_t stream) {
  for (Session& session : m_sessions)
    if (session.isOf(peer, stream)) return session;
  return m_sessions.emplace_back(peer, stream, m_maps, m_own);
}

/** Receivers take turns. */
void Station::sendOne() {
  if (Clock::now() < m_nextSending) return;
  for (auto s = m_sessions.begin(); s != m_sessions.end(); ++s) {
    const auto datagram = s->next();
    if (!datagram) continue;
    const std::string bytes = datagram->bytes();
    m_radio.send(s->peer(), bytes);
    const double seconds = m_options.rate > 0
                               ? 8.0 * static_cast<double>(bytes.size() + kHeaders) / m_options.rate
                               : 0;
    m_nextSending = std::max(m_nextSending, Clock::now() - kTick) +
                    std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
    m_sessions.splice(m_sessions.end(), m_sessions, s);
    return;
  }
  m_nextSending = std::max(m_nextSending, Clock::now() + std::chrono::milliseconds(1));
}

void Station::checkSilence() const {
  const auto now = Clock::now();
  for (const Session& s : m_sessions)
    if (!s.isDone() && now - s.lastHeard() > Seconds(m_options.timeout))
      throw std::runtime_error("the receiver " + s.peer().text() + " fell silent");
  const bool isIdle = std::all_of(m_sessions.begin(), m_sessions.end(),
                                  [](const Session& s) { return s.isDone(); });
  if (isIdle && now - m_lastHeard > Seconds(m_options.timeout))
    throw std::runtime_error("nobody asked for the map at port " + std::to_string(port()));
}

}  // namespace semantic_map_send
