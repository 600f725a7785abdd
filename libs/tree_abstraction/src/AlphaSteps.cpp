#include <tree_abstraction/AlphaPath.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace tree_abstraction {

AlphaSteps::AlphaSteps(std::vector<double> tau, const std::vector<double>& asked) {
  std::vector<double> wanted(asked);
  std::sort(wanted.begin(), wanted.end(), std::greater<>());
  std::sort(tau.begin(), tau.end(), std::greater<>());
  while (!tau.empty() && !(tau.back() > 0)) tau.pop_back();
  if (!tau.empty()) m_highest = tau.front();
  auto next = wanted.begin();
  for (std::size_t i = 0; i < tau.size() && next != wanted.end();) {
    std::size_t end = i + 1;
    while (end < tau.size() && isTie(tau[end - 1], tau[end])) ++end;
    const double lowest = tau[end - 1];
    if (*next >= lowest) {
      m_lowest.push_back(lowest);
      m_next.push_back(end < tau.size() ? tau[end] : 0.0);
    }
    while (next != wanted.end() && *next >= lowest) ++next;
    i = end;
  }
}

std::size_t AlphaSteps::stepOf(double tau) const {
  if (!(tau > 0)) return numSteps() - 1;
  const auto step =
      std::lower_bound(m_lowest.begin(), m_lowest.end(), tau, std::greater<>());  // not above tau
  return static_cast<std::size_t>(step - m_lowest.begin()) + 1;
}

double AlphaSteps::highestAlpha(std::size_t step) const {
  return step == 0 ? std::numeric_limits<double>::infinity() : m_lowest.at(step - 1);
}

double AlphaSteps::alpha(std::size_t step) const {
  return alphaBetween(step == 0 ? m_highest : m_next.at(step - 1), highestAlpha(step));
}

}  // namespace tree_abstraction
