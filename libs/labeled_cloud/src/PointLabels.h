#pragma once
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/obs/CObservation.h>
#include <semantic_types/LabeledCloud.h>
#include <strict_files/OptionList.h>

#include <string>
#include <vector>

namespace labeled_cloud {

/** The source that reads this observation, null if there is none. */
std::shared_ptr<const PointSource> pointSourceOf(const mrpt::obs::CObservation& observation);

/** The labels of a cloud's points, taken from one label image or several of the same kind. */
class PointLabels {
 public:
  explicit PointLabels(std::size_t points) : m_points(points) {}

  /** Gives a point the label of an image's cell. */
  void take(std::size_t point, const LabelImage& image, std::size_t cell);

  /** Puts classes or probabilities into the cloud; returns the classes' confidences. */
  std::vector<float> moveTo(semantic_types::LabeledCloud& cloud);

 private:
  std::size_t m_points;
  std::vector<semantic_types::ClassId> m_classes;
  std::vector<float> m_confidences, m_probabilities;
};

/** Name of an object's class, without its namespaces. */
inline std::string kindOf(const mrpt::rtti::CObject& o) {
  const std::string name = o.GetRuntimeClass()->className;
  return name.substr(name.rfind(':') + 1);
}

/** What messages call an observation: class, sensor, time. */
inline std::string nameOf(const mrpt::obs::CObservation& o) {
  return kindOf(o) + " '" + o.sensorLabel + "' at " +
         strict_files::textOf(mrpt::Clock::toDouble(o.timestamp)) + " s";
}

}  // namespace labeled_cloud
