#include "KittiCamera.h"

#include <labeled_cloud/Pictures.h>

#include <opencv2/core.hpp>
#include <stdexcept>

#include <strict_files/TextFile.h>

namespace dataset2rawlog {

using strict_files::numbersOf;
using strict_files::readLines;
using strict_files::TextLine;

namespace fs = std::filesystem;

namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Matrix34 readProjection(const fs::path& calib) {
  for (const TextLine& line : readLines(calib)) {
    if (line.text.rfind("P2:", 0) != 0) continue;
    const auto numbers = numbersOf(line, 12);
    const Matrix34 P = Eigen::Map<const Matrix34>(numbers.data());
    if (P(0, 0) > 0 && P(1, 1) > 0 && P(2, 2) == 1) return P;
    throw std::runtime_error(line.where + ": no projection of a camera");
  }
  throw std::runtime_error(calib.string() + ": no line 'P2:'");
}

}  // namespace

fs::path imagesOf(const fs::path& rawlog) {
  return fs::absolute(rawlog).parent_path() / (rawlog.stem().string() + "_Images");
}

KittiCamera::KittiCamera(const fs::path& sequence, const Eigen::Isometry3d& T_camera0_lidar,
                         const fs::path& rawlog)
    : m_source(sequence / "image_2"), m_target(imagesOf(rawlog)) {
  const Matrix34 P = readProjection(sequence / "calib.txt");
  const Eigen::Matrix3d K = P.leftCols<3>();
  // P2 = K [I | t] takes points of the first camera: the color camera sees them shifted by t.
  const Eigen::Isometry3d T_camera2_lidar =
      Eigen::Translation3d(K.inverse() * P.col(3)) * T_camera0_lidar;
  m_T_lidar_camera =
      mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_camera2_lidar.inverse().matrix()));
  m_camera.setIntrinsicParamsFromValues(K(0, 0), K(1, 1), K(0, 2), K(1, 2));
}

mrpt::obs::CObservationImage KittiCamera::observe(const std::string& name,
                                                  mrpt::Clock::time_point time) {
  const fs::path file = m_source / (name + ".png");
  const cv::Mat image = labeled_cloud::readImageFile(file, labeled_cloud::ImageKinds::All);
  m_camera.ncols = static_cast<unsigned>(image.cols);
  m_camera.nrows = static_cast<unsigned>(image.rows);
  m_names.push_back(file.filename().string());
  fs::copy_file(file, m_target.staged(m_names.back()), fs::copy_options::overwrite_existing);
  mrpt::obs::CObservationImage observation;
  observation.timestamp = time;
  observation.sensorLabel = "image_2";
  observation.cameraParams = m_camera;
  observation.cameraPose = m_T_lidar_camera;
  observation.image.setExternalStorage(file.filename().string());
  return observation;
}

}  // namespace dataset2rawlog
