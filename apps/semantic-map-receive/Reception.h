#pragma once
#include <map_streams/MapStream.h>

#include <chrono>

#include "Signals.h"
#include "radio/BadRadio.h"
#include "radio/Cookies.h"
#include "radio/Seal.h"
#include "radio/Wish.h"

namespace semantic_map_receive {

struct ReceptionOptions {
  double timeout = 60;    ///< seconds without a word from the sender
  std::size_t bytes = 0;  ///< enough, see semantic_octree::StreamPrefix; 0: all
  double loss = 0;        ///< see radio::BadRadio
  unsigned seed = 2;
};

/** Receives one map. */
class Reception {
 public:
  /** \throw std::runtime_error the wish is too long. */
  Reception(const radio::Peer& sender, const radio::Wish& wish, const radio::Seal& seal,
            const ReceptionOptions& options);

  /** Until it is there, or enough of it, or the user stops it.
   * \param check is called with the empty map once it is known which classes it has
   * \throw std::runtime_error the sender is not there, refuses, or falls silent; what came is in
   * receiver() nevertheless. */
  template <typename Check>
  void receive(const StopRequest& stop, const Check& check);
  /** Tells the sender that this is all; it may say so too. */
  void end();
  const semantic_octree::MapReceiver& receiver() const { return m_receiver; }

 private:
  using Clock = std::chrono::steady_clock;
  using Datagram = semantic_octree::Datagram;
  bool isEnough() const;
  /** Waits for a datagram and takes it. \return whether one came */
  bool listen(std::chrono::milliseconds timeout);
  void take(const Datagram& datagram);
  void ask();
  void send(const Datagram& datagram) { m_radio.send(m_sender, m_seal.sealed(datagram.bytes())); }
  [[noreturn]] void failSilent() const;

  radio::Peer m_sender;
  radio::Seal m_seal;
  ReceptionOptions m_options;
  std::uint32_t m_stream;
  std::string m_cookie, m_wish;  ///< of a request
  radio::UdpSocket m_socket;
  radio::BadRadio m_radio;
  semantic_octree::MapReceiver m_receiver;
  bool m_isEnded = false;
  std::size_t m_numUnacknowledged = 0;
  Clock::time_point m_lastHeard, m_lastSent;
};

template <typename Check>
void Reception::receive(const StopRequest& stop, const Check& check) {
  bool isChecked = false;
  while (!stop.pending() && !m_isEnded && !isEnough()) {
    ask();
    listen(std::chrono::milliseconds(50));
    if (!isChecked && m_receiver.hasMap()) {
      check(m_receiver.map());
      isChecked = true;
    }
    if (Clock::now() - m_lastHeard > std::chrono::duration<double>(m_options.timeout)) failSilent();
  }
}

}  // namespace semantic_map_receive
