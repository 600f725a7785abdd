#include "Quantile.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace measuring {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) throw std::invalid_argument("a quantile of no values");
  if (!(share >= 0 && share <= 1))
    throw std::invalid_argument("a quantile's share is " + std::to_string(share) +
                                ", expected 0 to 1");
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), below, values.end());
  if (below + 1 == values.end()) return *below;
  const double above = *std::min_element(below + 1, values.end());
  return *below + (rank - static_cast<double>(below - values.begin())) * (above - *below);
}

}  // namespace measuring
