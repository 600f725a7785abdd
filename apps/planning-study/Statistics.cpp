#include "Statistics.h"

#include <cmath>
#include <numeric>
#include <random>

#include "measuring/Quantile.h"

namespace planning_study {

using measuring::quantile;

namespace {
constexpr int kResamples = 2000;
constexpr double kTail = 0.025;
}  // namespace

double mean(const std::vector<double>& sample) {
  if (sample.empty()) return 0;
  return std::accumulate(sample.begin(), sample.end(), 0.0) / static_cast<double>(sample.size());
}

double deviation(const std::vector<double>& sample) {
  if (sample.size() < 2) return 0;
  const double center = mean(sample);
  double squares = 0;
  for (const double x : sample) squares += (x - center) * (x - center);
  return std::sqrt(squares / static_cast<double>(sample.size() - 1));
}

Distribution describe(const std::vector<double>& sample) {
  if (sample.empty()) return {};
  Distribution d;
  d.count = sample.size();
  d.mean = mean(sample);
  d.deviation = deviation(sample);
  d.quartile1 = quantile(sample, 0.25);
  d.median = quantile(sample, 0.5);
  d.quartile3 = quantile(sample, 0.75);
  d.percentile5 = quantile(sample, 0.05);
  d.percentile95 = quantile(sample, 0.95);
  return d;
}

std::vector<double> pick(const std::vector<double>& sample, const std::vector<std::size_t>& which) {
  std::vector<double> picked;
  for (const std::size_t i : which) picked.push_back(sample[i]);
  return picked;
}

Interval bootstrap(std::size_t count, const Statistic& statistic, std::uint64_t seed) {
  if (count == 0) return {};
  std::mt19937_64 random(seed);
  std::vector<double> values;
  std::vector<std::size_t> drawn(count);
  for (int i = 0; i < kResamples; ++i) {
    for (std::size_t& index : drawn) index = random() % count;
    values.push_back(statistic(drawn));
  }
  return {quantile(values, kTail), quantile(values, 1 - kTail)};
}

}  // namespace planning_study
