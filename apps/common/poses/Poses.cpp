#include "Poses.h"

#include <mrpt/poses/CPose3D.h>
#include <strict_files/OptionList.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace poses {

using mrpt::math::TPose2D;

namespace {
constexpr double kDegree = M_PI / 180;
}

std::vector<double> parseNumbers(const std::string& text, std::size_t least, std::size_t most,
                                 const std::string& expected) {
  std::vector<double> numbers;
  std::istringstream in(text + ',');
  try {
    for (std::string part; std::getline(in, part, ',');)
      numbers.push_back(strict_files::numberOf(strict_files::trimmed(part), expected));
  } catch (const std::invalid_argument&) {
    numbers = {NAN};
  }
  const auto isFinite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(numbers.begin(), numbers.end(), isFinite) || numbers.size() < least ||
      numbers.size() > most)
    throw std::invalid_argument("expected " + expected + ", found '" + text + "'");
  return numbers;
}

TPose2D parsePose(const std::string& text) {
  const auto n = parseNumbers(text, 3, 3, "X,Y,DEG (meters and degrees)");
  return {n[0], n[1], n[2] * kDegree};
}

CLI::Option* addPose(CLI::App& app, const std::string& name, TPose2D& pose,
                     const std::string& description) {
  const auto take = [&pose](const std::string& text) { pose = parsePose(text); };
  return addParsed(app, name, "X,Y,DEG", take, description);
}

Eigen::Isometry3d poseOfNumbers(const std::array<double, 6>& v) {
  const mrpt::poses::CPose3D pose(v[0], v[1], v[2], v[3] * kDegree, v[4] * kDegree, v[5] * kDegree);
  return Eigen::Isometry3d(pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
}

Eigen::Isometry3d poseOfMatrix(const strict_files::TextLine& line) {
  const auto numbers = numbersOf(line, 12);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d R = T.linear();
  if (!(R * R.transpose()).isIdentity(1e-3) || R.determinant() < 0)
    throw std::runtime_error(line.where + ": the first three columns are no rotation");
  // The files round to six digits: the nearest rotation keeps inverse and product rigid.
  T.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  return T;
}

}  // namespace poses
