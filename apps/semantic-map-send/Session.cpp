#include "Session.h"

#include <semantic_abstraction/Abstraction.h>

namespace semantic_map_send {
namespace {

/** So long after all was sent, what was not acknowledged goes out again. */
constexpr std::chrono::milliseconds kPatience(500);

}  // namespace

Session::Session(const radio::Peer& peer, std::uint32_t stream, Maps& maps, const radio::Wish& own)
    : m_peer(peer),
      m_stream(stream),
      m_maps(maps),
      m_own(own),
      m_sender(stream),
      m_lastHeard(Clock::now()),
      m_lastSent(m_lastHeard) {}

void Session::accept(const Datagram& datagram) {
  m_lastHeard = Clock::now();
  switch (datagram.type) {
    case Datagram::Type::Request:
      if (!m_refusal.empty()) m_answer = answer(Datagram::Type::Refusal, m_refusal);
      if (m_options || !m_refusal.empty()) return;
      if (const auto wish = m_request.add(datagram)) begin(*wish);
      return;
    case Datagram::Type::Receipt:
      if (!m_options) return;
      m_sender.accept(datagram);
      if (!m_sender.isComplete()) return;
      if (m_nextMap < m_maps.size()) return sendNextMap();
      m_isDone = true;
      m_answer = answer(Datagram::Type::End, "");
      return;
    case Datagram::Type::End:
      m_isDone = true;
      m_answer = answer(Datagram::Type::End, "");
      return;
    default:
      return;
  }
}

void Session::begin(radio::Wish wish) {
  try {
    if (wish.weights.empty()) wish.weights = m_own.weights;
    if (wish.solution.empty()) wish.solution = m_own.solution;
    m_options = wish.forClasses(m_maps.front().tree().classes(), "weights");
    sendNextMap();
  } catch (const std::exception& e) {
    m_options.reset();
    m_refusal = std::string(e.what()).substr(0, semantic_octree::kMaxDatagramBytes / 2);
    m_answer = answer(Datagram::Type::Refusal, m_refusal);
    m_isDone = true;
  }
}

void Session::sendNextMap() {
  semantic_octree::SemanticOcTree& map = m_maps[m_nextMap++].tree();
  setAbstraction(map, *m_options);
  m_sender.setMap(map, m_nextMap == m_maps.size());
  dropAbstraction(map);
  m_lastHeard = Clock::now();  // it did not have to wait for us
}

std::optional<Datagram> Session::next() {
  std::optional<Datagram> datagram = std::exchange(m_answer, std::nullopt);
  if (!datagram && m_options && !m_isDone) {
    datagram = m_sender.next();
    if (!datagram && Clock::now() - m_lastSent > kPatience) {
      m_sender.repeat();
      datagram = m_sender.next();
    }
  }
  if (!datagram) return datagram;
  m_lastSent = Clock::now();
  ++m_numSent;
  m_bytesSent += datagram->bytes().size();
  return datagram;
}

}  // namespace semantic_map_send
