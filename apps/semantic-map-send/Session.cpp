#include "Session.h"

#include <semantic_abstraction/Abstraction.h>

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

}  // namespace semantic_map_send
