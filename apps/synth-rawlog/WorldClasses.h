#pragma once
#include <synthetic_world/Sensors.h>
#include <synthetic_world/Solids.h>

#include <filesystem>

namespace synth_rawlog {

/** The classes that things of the world have in the rawlog. */
class WorldClasses {
 public:
  /** \param file class table (YAML) whose raw ids are the world's classes; empty: the world's own
   * \throw std::runtime_error naming the file: it cannot be read, does not know a class of the
   * world, or has more classes than a camera's labels. */
  explicit WorldClasses(const std::filesystem::path& file);

  const synthetic_world::ClassTable& table() const { return m_table; }
  synthetic_world::ClassId of(synthetic_world::ClassId inWorld) const { return m_ids[inWorld]; }
  synthetic_world::CameraFrame of(synthetic_world::CameraFrame frame) const;
  synthetic_world::LabeledCloud of(synthetic_world::LabeledCloud cloud) const;

 private:
  synthetic_world::ClassTable m_table;
  std::vector<synthetic_world::ClassId> m_ids;  ///< by the world's
};

}  // namespace synth_rawlog
