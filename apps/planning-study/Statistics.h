#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace planning_study {

/** What is reported of a sample; all 0 if it is empty. */
struct Distribution {
  std::size_t count = 0;
  double mean = 0;
  double deviation = 0;  ///< with n - 1; 0 for a single value
  double quartile1 = 0, median = 0, quartile3 = 0;
  double percentile5 = 0, percentile95 = 0;
};
Distribution describe(const std::vector<double>& sample);

double mean(const std::vector<double>& sample);
double deviation(const std::vector<double>& sample);

struct Interval {
  double low = 0, high = 0;
};

/** Picks values of a sample, some more than once. */
std::vector<double> pick(const std::vector<double>& sample, const std::vector<std::size_t>& which);

/** A statistic of the instances with these indices, of which some appear more than once. */
using Statistic = std::function<double(const std::vector<std::size_t>&)>;

/** Its 95 % interval by the percentile bootstrap (Efron 1979): instances are drawn with
 * replacement, 2000 times. A statistic of pairs stays one: both members come with an instance.
 * \param count of instances; 0 gives {0, 0} */
Interval bootstrap(std::size_t count, const Statistic& statistic, std::uint64_t seed = 1);

}  // namespace planning_study
