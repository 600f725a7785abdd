#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_driving/DrivePath.h>

namespace semantic_driving {

/** Where a drive wants all detail of the compressed tree: p(x) of the abstraction is 1 around the
 * vehicle and along the path ahead, and 0 elsewhere. */
struct FocusOptions {
  double corridor = 0;  ///< on both sides of the path ahead, meters; 0: p(x) is 1 everywhere
  double around = 0;    ///< around the vehicle, meters; 0: a Navigator takes where obstacles matter

  bool isOn() const { return corridor > 0; }
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** The regions of p(x) for a vehicle (map frame, meters) on its path; none without a focus. A
 * stretch of the path keeps its region as long as any of it is ahead, so that little changes from
 * call to call. */
std::vector<semantic_octree::Region> regionsAhead(const DrivePath& path, double progress,
                                                  const Eigen::Vector3d& vehicle,
                                                  const FocusOptions& options);

}  // namespace semantic_driving
