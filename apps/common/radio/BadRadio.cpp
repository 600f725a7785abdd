#include "BadRadio.h"

namespace radio {
namespace {

constexpr double kTwice = 0.1, kLate = 0.25;

}  // namespace

bool BadRadio::chance(double p) { return static_cast<double>(m_random()) < p * 4294967296.0; }

void BadRadio::send(const Peer& to, const std::string& bytes) {
  if (m_loss == 0) return m_socket.send(to, bytes);
  if (chance(m_loss)) return;
  if (!m_late && chance(kLate)) {
    m_late.emplace(to, bytes);
    return;
  }
  m_socket.send(to, bytes);
  if (chance(kTwice)) m_socket.send(to, bytes);
  if (m_late) m_socket.send(m_late->first, m_late->second);
  m_late.reset();
}

}  // namespace radio
