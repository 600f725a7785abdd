#include "WorldClasses.h"

#include <semantic_types/ClassTable.h>

#include <stdexcept>

#include "synthetic_rawlog/Observations.h"

namespace synth_rawlog {

using synthetic_world::ClassId;

WorldClasses::WorldClasses(const std::filesystem::path& file)
    : m_table(file.empty() ? synthetic_world::classTable() : semantic_types::loadClassTable(file)),
      m_ids{synthetic_world::kNoClass} {
  const auto fail = [&file](const std::string& what) {
    throw std::runtime_error(file.string() + ": " + what);
  };
  if (m_table.size() > synthetic_rawlog::kMostPixelClasses)
    fail(std::to_string(m_table.size()) + " classes, and a pixel's labels hold 31");
  for (int id = 1; id <= synthetic_world::kClassCount; ++id) try {
      m_ids.push_back(m_table.fromRaw(static_cast<std::uint32_t>(id)));
    } catch (const std::invalid_argument& e) {
      fail(e.what());
    }
}

synthetic_world::CameraFrame WorldClasses::of(synthetic_world::CameraFrame frame) const {
  for (ClassId& id : frame.labels.pixels) id = of(id);
  return frame;
}

synthetic_world::LabeledCloud WorldClasses::of(synthetic_world::LabeledCloud cloud) const {
  for (ClassId& id : cloud.classes) id = of(id);
  return cloud;
}

}  // namespace synth_rawlog
