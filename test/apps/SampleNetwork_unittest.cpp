// A network that thresholds colors labels the sample as its colors say, through the whole
// application.
#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt_compat/Images.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <cmath>

#include "NearestColorNetwork.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;
using labeled_cloud::CObservationLabeledCloud;
using mrpt::obs::CObservation3DRangeScan;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

const fs::path kSources = MSO_SOURCE_DIR;

template <typename Observation>
std::vector<std::shared_ptr<Observation>> readAll(const fs::path& rawlog,
                                                  const std::string& sensor) {
  std::vector<std::shared_ptr<Observation>> found;
  labeled_cloud::RawlogReader reader(rawlog);
  while (const auto entry = reader.next())
    for (const auto& o : entry->observations)
      if (auto known = std::dynamic_pointer_cast<Observation>(o); known && o->sensorLabel == sensor)
        found.push_back(known);
  return found;
}

/** Softmax of -sharpness * squared distance to the classes' colors, at one pixel. */
std::vector<double> answerFor(const cv::Vec3b& pixel, const ClassTable& table) {
  std::vector<double> p;
  double sum = 0;
  for (int id = 1; id <= table.size(); ++id) {
    const auto& c = table.color(static_cast<ClassId>(id));
    const double r = (pixel[2] - c.r) / 255.0, g = (pixel[1] - c.g) / 255.0,
                 b = (pixel[0] - c.b) / 255.0;
    p.push_back(std::exp(-kSharpness * (r * r + g * g + b * b)));
    sum += p.back();
  }
  for (double& value : p) value /= sum;
  return p;
}

}  // namespace

TEST(SampleNetwork, labelsTheVillageAsItsColorsSayHardAndSoft) {
  const fs::path rawlog = kSources / "rawlog-samples/village.rawlog";
  const fs::path classes = kSources / "config/classes/synthetic.yaml";
  const ClassTable table = semantic_types::loadClassTable(classes);
  const auto frames = readAll<CObservation3DRangeScan>(rawlog, "CAMERA");
  ASSERT_FALSE(frames.empty());
  const int rows = int(frames[0]->cameraParams.nrows), cols = int(frames[0]->cameraParams.ncols);
  const TemporaryFolder folder;
  saveNearestColorNetwork(folder / "net.onnx", rows, cols, table);
  folder.write("net.yaml", nearestColorConfig(rows, cols, table));
  for (const char* kind : {"soft", "hard"}) {
    folder.write("plain.ini",
                 std::string("[map]\nresolution = 0.4\n[labels]\nkind = ") + kind + "\n");
    const ProgramRun run = runProgram(
        "rawlog2semantic-map",
        {"--config", (folder / "plain.ini").string(), "--classes", classes.string(), "--output",
         (folder / "out").string(), "--network", (folder / "net.onnx").string(), "--network-config",
         (folder / "net.yaml").string(), "--save-labeled", (folder / "saved.rawlog").string(), "-f",
         rawlog.string()});
    ASSERT_EQ(run.status, 0) << run.errors;
    const auto saved = readAll<CObservationLabeledCloud>(folder / "saved.rawlog", "CAMERA");
    ASSERT_EQ(saved.size(), frames.size());
    std::size_t compared = 0, wrong = 0;
    for (std::size_t f = 0; f < frames.size(); f += 8) {
      const auto& cloud = saved[f]->cloud;
      const cv::Mat image = mrpt_compat::toOpenCv(frames[f]->intensityImage);
      std::size_t point = 0;
      for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
          if (frames[f]->rangeImage(row, col) == 0) continue;
          const auto p = answerFor(image.at<cv::Vec3b>(row, col), table);
          const double best = *std::max_element(p.begin(), p.end());
          ++compared;
          if (cloud.probabilities.empty())
            wrong += best - p[cloud.classes[point] - 1u] > 1e-3;
          else
            for (std::size_t k = 0; k < p.size(); ++k)
              wrong += std::abs(cloud.probabilities[point * p.size() + k] - p[k]) > 1e-3;
          ++point;
        }
      ASSERT_EQ(point, cloud.size());
    }
    EXPECT_GT(compared, 50000u);
    EXPECT_LT(wrong, compared / 10000) << kind;
  }
}
