#pragma once
#include <map_folders/MapFolder.h>
#include <map_streams/MapStream.h>
#include <semantic_abstraction/AbstractionOptions.h>

#include <chrono>
#include <deque>
#include <list>

#include "Signals.h"
#include "radio/Seal.h"
#include "radio/UdpSocket.h"
#include "radio/Wish.h"

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

/** How the radio is, and whom it serves. */
struct StationOptions {
  int port = 4217;
  double rate = 0;      ///< bits a second, with the headers of IP and UDP; 0: as fast as can be
  double timeout = 60;  ///< seconds
  std::size_t receivers = 1;
  double loss = 0;  ///< see radio::BadRadio
  unsigned seed = 1;
};

/** Serves receivers, several at once, at one rate for all of them. Nothing is kept of who asks
 * until a whole request shows the cookie that was sent to it, and then for kMostAtOnce receivers at
 * most: others ask until there is room. */
class Station {
 public:
  static constexpr std::size_t kMostAtOnce = 16, kMostOfAddress = 4;

  /** \param own What receivers get that do not ask for anything else
   * \throw std::runtime_error the port cannot be used. */
  Station(Maps& maps, const radio::Wish& own, const radio::Seal& seal,
          const StationOptions& options);

  int port() const { return m_socket.port(); }
  /** Until so many receivers were served, or the user stops it.
   * \throw std::runtime_error nobody is left who asks: naming the last that fell silent, if any. */
  void serve(const StopRequest& stop);

 private:
  using Seconds = std::chrono::duration<double>;
  bool isOver() const;
  void listen(Clock::duration most);
  bool take(const radio::Peer& from, const Datagram& datagram);
  bool begin(const radio::Peer& from, const Datagram& request);
  bool hasRoomFor(const radio::Peer& from) const;
  bool sendOne();
  void send(const radio::Peer& to, const Datagram& datagram);
  void forgetSilent();
  std::size_t numServed() const;

  Maps& m_maps;
  radio::Wish m_own;
  radio::Seal m_seal;
  StationOptions m_options;
  radio::UdpSocket m_socket;
  radio::BadRadio m_radio;
  radio::Cookies m_cookies;
  std::list<Session> m_sessions;  ///< whose turn it is first
  /** To one who has no session, and whether the last datagram was such. */
  std::optional<std::pair<radio::Peer, Datagram>> m_answer;
  bool m_hasAnswered = false;
  std::string m_silence;  ///< what to say if nobody is heard
  Clock::time_point m_nextSending, m_lastHeard;
  Clock::time_point m_lastBusy;  ///< then a map was prepared, and nobody heard
};

}  // namespace semantic_map_send
