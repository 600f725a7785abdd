#pragma once
#include "Runner.h"

namespace insertion_benchmark {

/** One runner's figures; times are milliseconds per scan. */
struct Result {
  std::string name;
  std::vector<double> cpuMedians, wallMedians;  ///< over the scans, one for each repeat
  std::vector<double> cpu95thPercentiles;
  double mapBytes = 0;   ///< resident memory after the last scan, less that before the first
  double peakBytes = 0;  ///< the most meanwhile
  double touchedVoxels = 0;

  double cpu() const;
  double wall() const;
  double cpu95thPercentile() const;
  /** (largest - smallest) / median of the repeats. */
  double spread() const;
};

double median(const std::vector<double>& values);

/** Lets each runner insert all scans, in turns, each turn in a process of its own.
 * \param onTurn told before each turn */
std::vector<Result> compare(const std::vector<Entry>& entries, const Scene& scene,
                            const Settings& settings, int repeats,
                            const std::function<void(const std::string&)>& onTurn);

}  // namespace insertion_benchmark
