#include "Reception.h"

#include <ostream>

#include "StandardOutput.h"

namespace semantic_map_receive {
namespace {

using std::chrono::milliseconds;

/** The silence before a request or a receipt goes out again. */
constexpr milliseconds kPatience(200);
constexpr std::size_t kPacketsPerReceipt = 16;
/** So often the sender is told that all is there, unless it says so, too. */
constexpr int kFarewells = 10;

}  // namespace

Reception::Reception(const radio::Peer& sender, const radio::Wish& wish, const radio::Seal& seal,
                     const ReceptionOptions& options)
    : m_sender(sender),
      m_seal(seal),
      m_options(options),
      m_stream(std::random_device()()),
      m_cookie(radio::Cookies::kBytes, '\0'),
      m_wish(wish.packed()),
      m_socket(0),
      m_radio(m_socket, options.loss, options.seed),
      m_receiver(m_stream),
      m_lastHeard(Clock::now()),
      m_lastSent(m_lastHeard - std::chrono::hours(1)) {}

bool Reception::isEnough() const {
  return m_receiver.isFinished() ||
         (m_options.bytes > 0 && m_receiver.prefix().bytes >= m_options.bytes);
}

void Reception::ask() {
  const bool isDue = Clock::now() - m_lastSent > kPatience;
  const bool isAnswered = m_receiver.numExpected() > 0;
  if (!isDue && !(isAnswered && m_numUnacknowledged >= kPacketsPerReceipt)) return;
  send(isAnswered ? m_receiver.receipt()
                  : Datagram{Datagram::Type::Request, m_stream, m_cookie + m_wish});
  m_numUnacknowledged = 0;
  m_lastSent = Clock::now();
}

bool Reception::listen(milliseconds timeout) {
  radio::Peer from;
  const auto bytes = m_socket.receive(from, timeout);
  if (!bytes || !(from == m_sender)) return false;
  std::optional<Datagram> datagram;
  try {
    datagram = Datagram::of(m_seal.opened(*bytes));
    if (datagram->stream != m_stream) return false;
  } catch (const std::runtime_error& e) {
    details() << from.text() << ": " << e.what() << std::endl;
    return false;
  }
  m_lastHeard = Clock::now();
  take(*datagram);
  return true;
}

void Reception::take(const Datagram& datagram) {
  if (datagram.type == Datagram::Type::Refusal)
    throw std::runtime_error("the sender " + m_sender.text() + " refuses: " + datagram.payload);
  if (datagram.type == Datagram::Type::End) m_isEnded = true;
  if (datagram.type == Datagram::Type::Cookie && datagram.payload != m_cookie) {
    m_cookie = datagram.payload;
    m_lastSent = {};  // asks at once
  }
  if (datagram.type != Datagram::Type::Data) return;
  const bool wasComplete = m_receiver.isComplete();
  m_receiver.accept(datagram);
  ++m_numUnacknowledged;
  if (m_receiver.isComplete() && !wasComplete) send(m_receiver.receipt());
}

void Reception::end() {
  for (int i = 0; i < kFarewells && !m_isEnded; ++i) {
    send(m_receiver.isFinished() ? m_receiver.receipt()
                                 : Datagram{Datagram::Type::End, m_stream, ""});
    for (const auto until = Clock::now() + kPatience; Clock::now() < until && !m_isEnded;)
      listen(milliseconds(20));
  }
}

void Reception::failSilent() const {
  if (m_receiver.numExpected() == 0)
    throw std::runtime_error("nobody answers at " + m_sender.text());
  throw std::runtime_error("the sender " + m_sender.text() + " fell silent after " +
                           std::to_string(m_receiver.numPackets()) + " of " +
                           std::to_string(m_receiver.numExpected()) + " packets");
}

}  // namespace semantic_map_receive
