// The options of this library: what they may be, and their names in files.
#include <semantic_octree/FilterParameters.h>
#include <semantic_octree/InsertionOptions.h>
#include <semantic_types/ClassTable.h>

#include <cmath>

namespace semantic_octree {

using strict_files::above;
using strict_files::atLeast;
using strict_files::between;
using strict_files::checkOptions;
using strict_files::Choices;
using strict_files::OptionList;
using strict_files::require;

/** Log-odds of what is likelier than this, and less likely than the rest, fit into 16 bits. */
static constexpr double kLeastProbability = 1e-9;

const Choices<InsertionOptions::Rays>& choicesOf(InsertionOptions::Rays) {
  using Rays = InsertionOptions::Rays;
  static const Choices<Rays> choices = {{"all", Rays::All}, {"end_voxels", Rays::EndVoxels}};
  return choices;
}

void InsertionOptions::describe(OptionList& list) {
  list.add("rays", rays, "",
           "rays that carve free space: all, or one for each voxel that was hit, which is faster "
           "and gives nearly "
           "the same map");
  list.add("max_range", maxRange, "m", atLeast(0),
           "returns beyond it only carve free space; 0: no limit. Where the sensor or its labels "
           "become bad: 30 for LiDARs, 5 for depth cameras");
  list.add("min_range", minRange, "m", between(0, 1000),
           "nearer returns are ignored: the robot itself");
  list.add("threads", threads, "", between(1, 256),
           "threads that share the work on a scan; the map does not depend on it");
}

void InsertionOptions::validate() const {
  checkOptions(*this, "InsertionOptions");
  require(maxScanMemory >= 1 && maxScanMemory <= 1000000, "InsertionOptions::maxScanMemory",
          maxScanMemory, "1 to 1000000 MB");
  require(carvingMargin >= 0 && std::isfinite(carvingMargin), "InsertionOptions::carving_margin",
          carvingMargin, "a number of 0 or more");
  require(maxRange == 0 || minRange < maxRange, "InsertionOptions::min_range", minRange,
          "less than max_range");
}

void FilterParameters::describe(OptionList& list) {
  const auto probability = above(0).below(1);
  list.add(
      "accuracy", accuracy, "", probability,
      "share of labels that name the true class, above 1 / number of classes; less for scans whose "
      "labels disagree within voxels more than that allows. Too large, and a few wrong labels win; "
      "too small, and it takes many scans to be sure");
  list.add("label_correlation", labelCorrelation, "", between(0, 1),
           "correlation of a scan's labels in one voxel, at most; less for scans whose labels "
           "disagree there. "
           "0: each counts by itself; 1: many that agree say no more than one");
  list.add("hit_probability", hitProbability, "", above(0).upTo(1 - kLeastProbability),
           "probability of a return from an occupied voxel that a beam reaches: 0.5 for LiDARs "
           "outdoors, 0.9 for "
           "depth cameras");
  list.add("false_alarm_probability", falseAlarmProbability, "", probability,
           "probability of a return from a free voxel, below hit_probability. Larger: moving "
           "objects leave less "
           "behind; smaller: thin things survive");
}

void FilterParameters::validate(int numClasses) const {
  FilterParameters copy = *this;
  OptionList all;
  copy.describe(all);
  all.add("min_occupancy", copy.minOccupancy, "", atLeast(kLeastProbability).below(0.5), "");
  all.add("max_probability", copy.maxProbability, "", above(0.5).upTo(1 - kLeastProbability), "");
  all.add("soft_label_floor", copy.softLabelFloor, "", above(0).below(1), "");
  all.add("calibration.power", copy.calibration.power, "", above(0).upTo(4), "");
  all.add("calibration.shared", copy.calibration.shared, "", atLeast(0).below(1), "");
  checkAll(all, "FilterParameters");
  const std::vector<double>& factors = calibration.factors;
  require(factors.empty() || factors.size() == static_cast<std::size_t>(numClasses),
          "FilterParameters::calibration.factors", factors.size(),
          "a number for each class, or none");
  constexpr double kMost = Calibration::kMostFactor;
  for (const double w : factors)
    require(w >= 1 / kMost && w <= kMost, "FilterParameters::calibration.factors", w,
            "1/65536 to 65536");
  require(numClasses >= 1 && numClasses <= semantic_types::kMaxClasses, "number of classes",
          numClasses, "1 to 254");
  require(classPrior.empty() || classPrior.size() == static_cast<std::size_t>(numClasses),
          "FilterParameters::class_prior", classPrior.size(), "a number for each class, or none");
  for (const float p : classPrior)
    require(p > 0 && p <= 1, "FilterParameters::class_prior", p, "above 0, up to 1");
  require(falseAlarmProbability < hitProbability, "FilterParameters::false_alarm_probability",
          falseAlarmProbability, "less than hit_probability");
  require(numClasses == 1 || accuracy * numClasses > 1, "FilterParameters::accuracy", accuracy,
          "more than 1 / number of classes");
}

bool FilterParameters::operator==(const FilterParameters& o) const {
  return accuracy == o.accuracy && labelCorrelation == o.labelCorrelation &&
         hitProbability == o.hitProbability && falseAlarmProbability == o.falseAlarmProbability &&
         minOccupancy == o.minOccupancy && maxProbability == o.maxProbability &&
         softLabelFloor == o.softLabelFloor;
}

}  // namespace semantic_octree
