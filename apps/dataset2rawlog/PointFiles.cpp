#include <labeled_cloud/PointFile.h>
#include <semantic_types/ClassTable.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "Conversion.h"
#include "Output.h"

namespace dataset2rawlog {

namespace fs = std::filesystem;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kMaxClasses;
using semantic_types::LabeledCloud;

namespace {

ClassId classOf(std::uint32_t label, const ClassTable& table) {
  if (!table.empty()) return table.fromRaw(label);
  if (label > static_cast<std::uint32_t>(kMaxClasses))
    throw std::invalid_argument("label " + std::to_string(label) + " is not one of 0..254");
  return static_cast<ClassId>(label);
}

/** As the sensor saw them. */
LabeledCloud cloudOf(const labeled_cloud::PointFile& points, const fs::path& file,
                     const ClassTable& table) {
  LabeledCloud cloud;
  const Eigen::Isometry3d T_sensor_file = points.T_file_sensor.inverse();
  for (const Eigen::Vector3d& p_file : points.points)
    cloud.points.push_back((T_sensor_file * p_file).cast<float>());
  for (const std::uint32_t label : points.labels) try {
      cloud.classes.push_back(classOf(label, table));
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ": point " + std::to_string(cloud.classes.size()) +
                               ": " + e.what());
    }
  return cloud;
}

}  // namespace

Summary convertPointFiles(const std::vector<fs::path>& files, const std::string& labelField,
                          const Conversion& conversion) {
  const ClassTable table = conversion.classes.empty()
                               ? ClassTable()
                               : semantic_types::loadClassTable(conversion.classes);
  Output output(conversion, table);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!output.wants(i, files.size())) continue;
    const auto points = labeled_cloud::readPointFile(files[i], conversion.labels ? labelField : "");
    const auto time = mrpt::Clock::fromDouble(static_cast<double>(i));
    const mrpt::math::CMatrixDouble44 pose(points.T_file_sensor.matrix());
    output.writePose(time, mrpt::poses::CPose3D(pose));
    output.writeCloud(time, "pcd", cloudOf(points, files[i], table));
  }
  return output.finish();
}

}  // namespace dataset2rawlog
