#include <labeled_cloud/CloudLabeler.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/math/TPose3D.h>
#include <strict_files/TextFile.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace labeled_cloud {

using mrpt::DEG2RAD;

namespace {

std::vector<double> numbersIn(const char* option, const std::string& text) {
  std::istringstream stream(text);
  const strict_files::ClassicNumbers classic(stream);
  std::vector<double> numbers;
  for (double number; stream >> number;) numbers.push_back(number);
  if (!stream.eof() && !text.empty())
    throw std::invalid_argument(std::string(option) + " is '" + text + "', expected numbers");
  return numbers;
}

/** So many numbers, or none. */
std::vector<double> numbersIn(const char* option, const std::string& text, std::size_t count) {
  auto numbers = numbersIn(option, text);
  if (!numbers.empty() && numbers.size() != count)
    throw std::invalid_argument(std::string(option) + " is '" + text + "', expected " +
                                std::to_string(count) + " numbers");
  return numbers;
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
  list.add("size", size, "pixels", "of the images: columns, rows; numbers are separated by spaces");
  list.add("intrinsics", intrinsics, "pixels", "fx, fy, cx, cy");
  list.add("distortion", distortion, "", "model of the lens");
  list.add("dist", dist, "", "its coefficients in MRPT's order");
  list.add("pose", pose, "m, degrees",
           "x, y, z, yaw, pitch, roll of the optical frame (x right, y down, z forward) on the "
           "robot");
}

CameraCalibration CameraDescription::calibration() const {
  CameraCalibration calibration;
  mrpt::img::TCamera camera;
  camera.distortion = distortion == Distortion::PlumbBob
                          ? mrpt::img::DistortionModel::plumb_bob
                          : mrpt::img::DistortionModel::kannala_brandt;
  const auto coefficients = numbersIn("dist", dist);
  std::copy_n(coefficients.begin(), std::min(coefficients.size(), camera.dist.size()),
              camera.dist.begin());
  const auto pixels = numbersIn("size", size, 2), optics = numbersIn("intrinsics", intrinsics, 4),
             p = numbersIn("pose", pose, 6);
  if (pixels.empty() != optics.empty())
    throw std::invalid_argument(std::string(pixels.empty() ? "size" : "intrinsics") +
                                " is missing");
  if (!pixels.empty()) {
    if (!(pixels[0] >= 1 && pixels[1] >= 1 && optics[0] > 0 && optics[1] > 0))
      throw std::invalid_argument("size is '" + size + "', intrinsics are '" + intrinsics +
                                  "', expected pixels and focal lengths above 0");
    camera.ncols = static_cast<unsigned>(pixels[0]);
    camera.nrows = static_cast<unsigned>(pixels[1]);
    camera.setIntrinsicParamsFromValues(optics[0], optics[1], optics[2], optics[3]);
    calibration.intrinsics = camera;
  }
  if (!p.empty())
    calibration.T_robot_camera =
        mrpt::poses::CPose3D(p[0], p[1], p[2], DEG2RAD(p[3]), DEG2RAD(p[4]), DEG2RAD(p[5]));
  return calibration;
}

}  // namespace labeled_cloud
