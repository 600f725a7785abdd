#pragma once
#include <list>

#include "Session.h"
#include "Signals.h"
#include "radio/BadRadio.h"

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

/** Serves receivers, several at once, at one rate for all of them. */
class Station {
 public:
  /** \throw std::runtime_error the port cannot be used. */
  Station(Maps& maps, const radio::Wish& own, const StationOptions& options);

  int port() const { return m_socket.port(); }
  /** Until so many receivers were served, or the user stops it.
   * \throw std::runtime_error naming the receiver that fell silent or was refused, or that nobody
   * asked. */
  void serve(const StopRequest& stop);

 private:
  using Seconds = std::chrono::duration<double>;
  void listen();
  Session& sessionOf(const radio::Peer& peer, std::uint32_t stream);
  void sendOne();
  void checkSilence() const;
  std::size_t numServed() const;

  Maps& m_maps;
  radio::Wish m_own;
  StationOptions m_options;
  radio::UdpSocket m_socket;
  radio::BadRadio m_radio;
  std::list<Session> m_sessions;  ///< whose turn it is first
  Clock::time_point m_begin, m_nextSending, m_lastHeard;
};

}  // namespace semantic_map_send
