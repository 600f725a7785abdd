#pragma once
#include <map_folders/MapFolder.h>

#include <chrono>
#include <deque>

#include "radio/UdpSocket.h"
#include "radio/Wish.h"

namespace semantic_map_send {

using Clock = std::chrono::steady_clock;
using semantic_octree::Datagram;

/** The maps to send, one after the other; all receivers get them. */
using Maps = std::deque<semantic_octree::StoredMap>;

/** One receiver: from its request to its last receipt. */
class Session {
 public:
  /** \param own What it gets if it does not ask for anything else */
  Session(const radio::Peer& peer, std::uint32_t stream, Maps& maps, const radio::Wish& own);

  const radio::Peer& peer() const { return m_peer; }
  bool isOf(const radio::Peer& peer, std::uint32_t stream) const {
    return m_peer == peer && m_stream == stream;
  }
  /** What the receiver sends. \throw std::runtime_error altered */
  void accept(const Datagram& datagram);
  /** What is to be sent to it now, if anything. */
  std::optional<Datagram> next();

  /** It has all maps, or enough, or was refused. */
  bool isDone() const { return m_isDone; }
  bool isServed() const { return m_isDone && m_refusal.empty(); }
  const std::string& refusal() const { return m_refusal; }
  Clock::time_point lastHeard() const { return m_lastHeard; }
  /** Datagrams, with those sent again; their bytes. */
  std::size_t numSent() const { return m_numSent; }
  std::size_t bytesSent() const { return m_bytesSent; }

 private:
  void begin(radio::Wish wish);
  void sendNextMap();
  Datagram answer(Datagram::Type type, const std::string& text) const {
    return {type, m_stream, text};
  }

  radio::Peer m_peer;
  std::uint32_t m_stream;
  Maps& m_maps;
  radio::Wish m_own;
  radio::WishReader m_request;
  std::optional<semantic_octree::AbstractionOptions> m_options;  ///< none: it has not asked yet
  semantic_octree::MapSender m_sender;
  std::size_t m_nextMap = 0;
  bool m_isDone = false;
  std::string m_refusal;
  std::optional<Datagram> m_answer;  ///< goes before all data
  Clock::time_point m_lastHeard, m_lastSent;
  std::size_t m_numSent = 0, m_bytesSent = 0;
};

}  // namespace semantic_map_send
