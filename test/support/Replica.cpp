#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

#include "DataSets.h"

namespace {

namespace fs = std::filesystem;

constexpr double kFocal = 256, kCenter = 255.5, kDepthPerMeter = 6553.5;

cv::Mat readImage(const fs::path& file, int type) {
  const cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (image.type() != type) throw std::runtime_error("cannot read " + file.string());
  return image;
}

LabeledFrame readFrame(const fs::path& folder, const std::string& name) {
  const cv::Mat depth = readImage(folder / "depth" / name, CV_16UC1);
  const cv::Mat label = readImage(folder / "label" / name, CV_8UC1);
  LabeledFrame frame;
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const double z = depth.at<std::uint16_t>(v, u) / kDepthPerMeter;
      if (z == 0) continue;
      const Eigen::Vector3d point((u - kCenter) / kFocal * z, (v - kCenter) / kFocal * z, z);
      frame.cloud.points.push_back(point.cast<float>());
      frame.cloud.classes.push_back(label.at<std::uint8_t>(v, u));
    }
  return frame;
}

}  // namespace

std::vector<LabeledFrame> readReplica(const fs::path& folder, std::size_t most) {
  std::vector<LabeledFrame> frames;
  std::ifstream poses(folder / "groundtruth.txt");
  for (std::string line; frames.size() < most && std::getline(poses, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream in(line);
    std::string time;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    in >> time >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    frames.push_back(readFrame(folder, time + ".png"));
    frames.back().T_map_sensor = Eigen::Translation3d(t) * q.normalized();
  }
  return frames;
}
