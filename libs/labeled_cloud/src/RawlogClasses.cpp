#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt_compat/Images.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace labeled_cloud {
namespace {

using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;

/** Hues that stay apart however many there are: each turns by the golden ratio. */
Color colorOfNumber(int number) {
  const double hue = std::fmod(number * 0.6180339887498949, 1.0);
  const auto color =
      mrpt_compat::colorOfHue(static_cast<float>(hue), 0.7f, number % 2 ? 0.9f : 0.65f);
  const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(255 * x)); };
  return {byte(color.R), byte(color.G), byte(color.B)};
}

class Collector {
 public:
  void add(const mrpt::obs::CObservation& observation) {
    if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(&observation))
      addCloud(*cloud);
    else if (const auto* scan =
                 dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation))
      if (scan->pixelLabels) addPixels(*scan->pixelLabels);
  }
  const ClassTable& table() const { return m_table; }

 private:
  void addCloud(const CObservationLabeledCloud& cloud) {
    for (const std::string& name : cloud.classNames) addName(name);
    if (!cloud.classNames.empty() || cloud.cloud.classes.empty()) return;
    const ClassId highest =
        *std::max_element(cloud.cloud.classes.begin(), cloud.cloud.classes.end());
    for (int id = 1; id <= highest; ++id) addName("class " + std::to_string(id));
  }
  void addPixels(const mrpt::obs::TPixelLabelInfoBase& labels) {
    for (const auto& [id, name] : labels.pixelLabelNames) addName(name);
  }
  void addName(const std::string& name) {
    if (!m_table.find(name)) m_table.add(name, colorOfNumber(m_table.size()));
  }

  ClassTable m_table;
};

}  // namespace

ClassTable classesIn(const std::vector<std::filesystem::path>& rawlogs) {
  Collector collector;
  for (const std::filesystem::path& file : rawlogs) {
    RawlogReader reader(file);
    try {
      while (const auto entry = reader.next())
        for (const auto& observation : entry->observations) collector.add(*observation);
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ": " + e.what());
    }
  }
  return collector.table();
}

}  // namespace labeled_cloud
