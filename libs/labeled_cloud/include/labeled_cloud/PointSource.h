#pragma once
#include <mrpt/obs/CObservation.h>
#include <semantic_types/LabeledCloud.h>

#include <memory>
#include <string>
#include <vector>

namespace labeled_cloud {

/** Points in the sensor's frame, meters; what was no return is (0, 0, 0) or not finite. Class id i
 * is called classNames[i - 1]; without names the ids are those of the user's class table. */
struct NamedCloud {
  semantic_types::LabeledCloud cloud;
  std::vector<std::string> classNames;
};

/** Reads the points of some classes of observations. ScanConverter knows labeled clouds, point
 * clouds, Velodyne packets and plane scanners by such sources; others are added. */
class PointSource {
 public:
  virtual ~PointSource() = default;
  virtual bool accepts(const mrpt::obs::CObservation& observation) const = 0;
  /** The points of an observation that it accepts, and that is loaded. Threads may ask at once.
   * \throw std::exception why it cannot be used */
  virtual NamedCloud read(const mrpt::obs::CObservation& observation) const = 0;
};

/** Every ScanConverter takes from now on what this source accepts; the one added last is asked
 * first. A library that MRPT loads calls this beside mrpt::rtti::registerClass(). Any thread may.
 */
void addPointSource(std::shared_ptr<const PointSource> source);

}  // namespace labeled_cloud
