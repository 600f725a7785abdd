#pragma once
#include <iosfwd>

#include "Comparison.h"

namespace insertion_benchmark {

/** What was measured on, and how. */
struct Conditions {
  std::string scene;
  std::size_t scans = 0, points = 0;
  Settings settings;
  int repeats = 0;
  double loadAverage = 0;    ///< of the machine, when it began
  double touchedVoxels = 0;  ///< 0: not counted
};

/** \param reference name of the runner that the others are compared with */
void printTable(std::ostream& out, const Conditions& conditions, const std::vector<Result>& results,
                const std::string& reference);
void printJson(std::ostream& out, const Conditions& conditions, const std::vector<Result>& results,
               const std::string& reference);

}  // namespace insertion_benchmark
