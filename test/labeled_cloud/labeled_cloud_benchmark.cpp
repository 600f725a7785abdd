// How long it takes to give labels to points, without reading or inserting them. One thread.
#include <benchmark/benchmark.h>
#include <labeled_cloud/CloudLabeler.h>
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/obs/CObservationImage.h>

#include <cmath>

#include "DepthCamera.h"

namespace {

using labeled_cloud::LabelImage;
using mrpt::poses::CPose3D;

constexpr int kClasses = 24;

semantic_types::ClassTable manyClasses() {
  semantic_types::ClassTable table;
  for (int id = 1; id <= kClasses; ++id) table.add(std::to_string(id), {});
  return table;
}

/** Stripes of classes, hard or soft. */
class Stripes : public labeled_cloud::ImageLabeler {
 public:
  Stripes(int rows, int cols, LabelImage::View view, bool soft) {
    m_image.rows = rows, m_image.cols = cols, m_image.view = view;
    const std::size_t cells = std::size_t(rows) * cols;
    if (soft) m_image.probabilities.assign(kClasses * cells, 1.f / kClasses);
    for (std::size_t i = 0; i < cells && !soft; ++i)
      m_image.classes.push_back(static_cast<semantic_types::ClassId>(1 + i / 16 % kClasses));
  }
  std::optional<LabelImage> label(const mrpt::obs::CObservation&) override { return m_image; }

 private:
  LabelImage m_image;
};

/** A frame of 640 x 480 of a room's corner; the color camera is 5 cm beside if it is another one.
 */
void frame(benchmark::State& state, LabelImage::View view, bool soft) {
  DepthCamera camera;
  camera.rows = 480, camera.cols = 640, camera.f = 525, camera.cx = 319.5, camera.cy = 239.5;
  const auto scan = camera.see([](int r, int c) { return 1.5 + 0.002 * c + 0.001 * r; });
  scan->cameraParamsIntensity = scan->cameraParams;
  if (view == LabelImage::View::Color) scan->relativePoseIntensityWRTDepth.y(-0.05);
  labeled_cloud::ScanConverter converter(manyClasses(), {},
                                         std::make_shared<Stripes>(480, 640, view, soft));
  for (auto _ : state) benchmark::DoNotOptimize(converter.convert(*scan)->cloud.size());
}
BENCHMARK_CAPTURE(frame, hard_aligned, LabelImage::View::Depth, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, hard_displaced, LabelImage::View::Color, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame, soft_aligned, LabelImage::View::Depth, true)
    ->Unit(benchmark::kMillisecond);

/** 120 thousand points around a LiDAR of 64 rings; a camera of KITTI's size sees a fifth of them.
 */
void scanAgainstImage(benchmark::State& state, bool soft) {
  std::vector<Eigen::Vector3f> points;
  for (int ring = 0; ring < 64; ++ring)
    for (int i = 0; i < 1875; ++i) {
      const double up = (2 - 0.42 * ring) * M_PI / 180, turn = 2 * M_PI * i / 1875;
      const double range = std::min(30.0, up < 0 ? 1.73 / std::sin(-up) : 30.0);
      points.push_back((range * Eigen::Vector3d(std::cos(up) * std::cos(turn),
                                                std::cos(up) * std::sin(turn), std::sin(up)))
                           .cast<float>());
    }
  labeled_cloud::Trajectory still;
  still.insert(mrpt::Clock::fromDouble(1), CPose3D());
  labeled_cloud::CloudLabeler labeler(
      std::make_shared<Stripes>(376, 1241, LabelImage::View::Color, soft), kClasses, {}, still);
  auto picture = mrpt::obs::CObservationImage::Create();
  picture->timestamp = mrpt::Clock::fromDouble(1);
  picture->cameraParams.ncols = 1241, picture->cameraParams.nrows = 376;
  picture->cameraParams.setIntrinsicParamsFromValues(719, 719, 607, 185);
  picture->cameraPose = CPose3D(0.27, 0.06, -0.08, -M_PI / 2, 0, -M_PI / 2);
  labeler.addPicture(picture);
  for (auto _ : state) {
    labeled_cloud::LabeledScan scan;
    scan.timestamp = picture->timestamp;
    scan.cloud.points = points;
    labeler.label(scan, CPose3D());
    benchmark::DoNotOptimize(scan.counts.labeled);
  }
}
BENCHMARK_CAPTURE(scanAgainstImage, hard, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scanAgainstImage, soft, true)->Unit(benchmark::kMillisecond);

}  // namespace
