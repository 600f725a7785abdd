#pragma once
#include <list>

#include "Session.h"
#include "Signals.h"
#include "radio/BadRadio.h"
#include "radio/Cookies.h"
#include "radio/Seal.h"
#include "radio/Wish.h"

namespace semantic_map_send {

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
