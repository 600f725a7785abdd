#pragma once
#include <vector>

namespace measuring {

/** The value that a share of the values lie below: between the two nearest of them in proportion
 * (type 7 of Hyndman, Fan 1996), as R and NumPy have it.
 * \param values in any order \param share in [0, 1]
 * \throw std::invalid_argument no values, or another share */
double quantile(std::vector<double> values, double share);

}  // namespace measuring
