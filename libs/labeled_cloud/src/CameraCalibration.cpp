#include <labeled_cloud/CloudLabeler.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/math/TPose3D.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace labeled_cloud {

using mrpt::DEG2RAD;
using strict_files::above;
using strict_files::atLeast;

namespace {

struct Named {
  const char* name;
  const std::optional<double>& value;
};

/** Whether these values are given. \throw std::invalid_argument some are, some are not. */
bool areGiven(const std::vector<Named>& values) {
  const auto isGiven = [](const Named& n) { return n.value.has_value(); };
  const auto missing = std::find_if_not(values.begin(), values.end(), isGiven);
  if (missing == values.end()) return true;
  if (std::none_of(values.begin(), values.end(), isGiven)) return false;
  throw std::invalid_argument(std::string(missing->name) + " is missing");
}

}  // namespace

const strict_files::Choices<CameraDescription::Distortion>& choicesOf(
    CameraDescription::Distortion) {
  using Distortion = CameraDescription::Distortion;
  static const strict_files::Choices<Distortion> choices = {
      {"plumb_bob", Distortion::PlumbBob}, {"kannala_brandt", Distortion::KannalaBrandt}};
  return choices;
}

void CameraDescription::describe(strict_files::OptionList& list) {
  list.add("cols", cols, "pixels", atLeast(1), "size of the images");
  list.add("rows", rows, "pixels", atLeast(1), "size of the images");
  list.add("fx", fx, "pixels", above(0), "focal length");
  list.add("fy", fy, "pixels", above(0), "focal length");
  list.add("cx", cx, "pixels", "principal point");
  list.add("cy", cy, "pixels", "principal point");
  list.add("distortion", distortion, "", "model of the lens");
  list.add("dist", dist, "", "its coefficients in MRPT's order, separated by spaces");
  list.add("pose_x", x, "m", "place of the camera on the robot");
  list.add("pose_y", y, "m", "place of the camera on the robot");
  list.add("pose_z", z, "m", "place of the camera on the robot");
  list.add("pose_yaw", yaw, "degrees", "of the optical frame: x right, y down, z forward");
  list.add("pose_pitch", pitch, "degrees", "of the optical frame");
  list.add("pose_roll", roll, "degrees", "of the optical frame");
}

CameraCalibration CameraDescription::calibration() const {
  CameraCalibration calibration;
  mrpt::img::TCamera camera;
  camera.distortion = distortion == Distortion::PlumbBob
                          ? mrpt::img::DistortionModel::plumb_bob
                          : mrpt::img::DistortionModel::kannala_brandt;
  std::istringstream stream(dist);
  const strict_files::ClassicNumbers classic(stream);
  std::size_t count = 0;
  for (double k; stream >> k && count < camera.dist.size();) camera.dist[count++] = k;
  if (!stream.eof() && !dist.empty())
    throw std::invalid_argument("dist is '" + dist + "', expected numbers");
  if (areGiven({{"cols", cols}, {"rows", rows}, {"fx", fx}, {"fy", fy}, {"cx", cx}, {"cy", cy}})) {
    camera.ncols = static_cast<unsigned>(*cols);
    camera.nrows = static_cast<unsigned>(*rows);
    camera.setIntrinsicParamsFromValues(*fx, *fy, *cx, *cy);
    calibration.intrinsics = camera;
  }
  if (areGiven({{"pose_x", x},
                {"pose_y", y},
                {"pose_z", z},
                {"pose_yaw", yaw},
                {"pose_pitch", pitch},
                {"pose_roll", roll}}))
    calibration.T_robot_camera =
        mrpt::poses::CPose3D(*x, *y, *z, DEG2RAD(*yaw), DEG2RAD(*pitch), DEG2RAD(*roll));
  return calibration;
}

}  // namespace labeled_cloud
