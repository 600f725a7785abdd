#include "Divergence.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace reference {

double jensenShannon(const Eigen::Ref<const Eigen::VectorXd>& pi, const ChildRows& p) {
  if (pi.size() != p.rows()) {
    throw std::invalid_argument("jensenShannon: " + std::to_string(pi.size()) + " shares for " +
                                std::to_string(p.rows()) + " children");
  }
  const auto children = static_cast<std::size_t>(p.rows());
  const auto outcomes = static_cast<std::size_t>(p.cols());
  return jensenShannon(pi.data(), p.data(), children, outcomes, outcomes);
}

void TermRows::project(const double* distribution, double* row) const {
  std::fill_n(row, width(), 0.0);
  for (const auto& [classId, entry] : contributions()) row[entry] += distribution[classId];
}

}  // namespace reference
