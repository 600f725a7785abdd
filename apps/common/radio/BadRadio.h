#pragma once
#include <random>

#include "UdpSocket.h"

namespace radio {

/** Loses a share of what is sent; a tenth of the rest is sent twice, and every fourth changes its
 * place with the next. With the same seed always the same ones. */
class BadRadio {
 public:
  /** \param loss 0: a good radio */
  BadRadio(UdpSocket& socket, double loss, unsigned seed)
      : m_socket(socket), m_random(seed), m_loss(loss) {}
  void send(const Peer& to, const std::string& bytes);

 private:
  bool chance(double p);

  UdpSocket& m_socket;
  std::mt19937 m_random;
  double m_loss;
  std::optional<std::pair<Peer, std::string>> m_late;
};

}  // namespace radio
