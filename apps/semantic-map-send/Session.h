#pragma once
#include <map_folders/MapFolder.h>
#include <map_streams/MapStream.h>
#include <semantic_abstraction/AbstractionOptions.h>

#include <chrono>
#include <deque>

#include "radio/UdpSocket.h"

namespace semantic_map_send {

using Clock = std::chrono::steady_clock;
using semantic_octree::Datagram;

/** The maps to send, one after the other; all receivers get them. */
using Maps = std::deque<semantic_octree::StoredMap>;

/** One receiver: from the request that was granted to its last receipt. */
class Session {
 public:
  /** Prepares the first map. \throw std::exception it cannot be sent with these options. */
  Session(const radio::Peer& peer, std::uint32_t stream, Maps& maps,
          const semantic_octree::AbstractionOptions& options);

  const radio::Peer& peer() const { return m_peer; }
  bool isOf(const radio::Peer& peer, std::uint32_t stream) const {
    return m_peer == peer && m_stream == stream;
  }
  /** What the receiver sends. \return whether it tells anything new, as none does that is repeated
   * \throw std::runtime_error altered */
  bool accept(const Datagram& datagram);
  /** What is to be sent to it now, if anything. */
  std::optional<Datagram> next();

  /** It has all maps, or enough. */
  bool isServed() const { return !m_sender; }
  /** When it told something new. */
  Clock::time_point lastHeard() const { return m_lastHeard; }
  /** Datagrams, with those sent again; their bytes. */
  std::size_t numSent() const { return m_numSent; }
  std::size_t bytesSent() const { return m_bytesSent; }

 private:
  void sendNextMap();
  bool take(const Datagram& receipt);

  radio::Peer m_peer;
  std::uint32_t m_stream;
  Maps& m_maps;
  semantic_octree::AbstractionOptions m_options;
  std::optional<semantic_octree::MapSender> m_sender;  ///< none: it is served
  std::size_t m_nextMap = 0;
  bool m_owesEnd = false;  ///< it has to be told that it is served
  Clock::time_point m_lastHeard, m_lastSent;
  std::size_t m_numSent = 0, m_bytesSent = 0;
};

}  // namespace semantic_map_send
