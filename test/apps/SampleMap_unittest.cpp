#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/Rawlogs.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt_compat/Images.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_types/ClassTable.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <vector>

#include "LabeledFrame.h"
#include "MapQuality.h"
#include "NearestColorNetwork.h"
#include "RunProgram.h"
#include "TemporaryFolder.h"

namespace fs = std::filesystem;

namespace {

/** The LiDAR scans of the shipped sample at their true poses. */
std::vector<LabeledFrame> readSampleScans() {
  const fs::path sources = MSO_SOURCE_DIR;
  const auto table = semantic_types::loadClassTable(sources / "config/classes/synthetic.yaml");
  const auto poses = labeled_cloud::loadTumTrajectory(sources / "rawlog-samples/village.tum");
  labeled_cloud::ScanConverter converter(table);
  labeled_cloud::RawlogReader reader(sources / "rawlog-samples/village.rawlog");
  std::vector<LabeledFrame> frames;
  while (const auto entry = reader.next())
    for (const auto& observation : entry->observations) {
      if (observation->sensorLabel != "LIDAR") continue;
      const auto scan = converter.convert(*observation);
      const auto pose = *poses.at(observation->timestamp) + scan->T_robot_sensor;
      frames.push_back({scan->cloud, Eigen::Isometry3d::Identity(), {}});
      frames.back().T_map_sensor.matrix() =
          pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
    }
  return frames;
}

}  // namespace

TEST(SampleMap, theVillageIsMappedWithItsClasses) {
  const TemporaryFolder folder;
  const fs::path sources = MSO_SOURCE_DIR;
  succeeded(
      runProgram("rawlog2semantic-map",
                 {"--config", (sources / "config/maps/synthetic.ini").string(), "--output",
                  folder.path().string(), (sources / "rawlog-samples/village.rawlog").string()}));

  const auto summary = nlohmann::json::parse(folder.read("summary.json"));
  EXPECT_EQ(summary["observations"]["inserted"], 48);
  for (const char* name : {"road", "sidewalk", "grass", "canopy", "building", "roof"})
    EXPECT_GT(summary["map"]["voxelsPerClass"][name], 500) << name;

  const auto map = semantic_octree::loadTree((folder / "map.semantic").string());
  MapQuality quality;
  for (const LabeledFrame& frame : readSampleScans()) judge(map, frame, 25, quality);
  EXPECT_GT(quality.coverage(), 0.95);
  EXPECT_GT(quality.accuracy(), 0.93);  // 2 % of the labels are wrong
}

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
    succeeded(runProgram(
        "rawlog2semantic-map",
        {"--config", (folder / "plain.ini").string(), "--classes", classes.string(), "--output",
         (folder / "out").string(), "--network", (folder / "net.onnx").string(), "--network-config",
         (folder / "net.yaml").string(), "--save-labeled", (folder / "saved.rawlog").string(), "-f",
         rawlog.string()}));
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

using labeled_cloud::LabelModel;
using semantic_octree::SemanticOcTree;
using semantic_types::LabeledCloud;

namespace {

/** Sees each class as a unit vector of its own, `kSignal` long, under normal noise; its answer is
 * the exact posterior with all classes equally likely before. */
class ConfusedClassifier {
 public:
  explicit ConfusedClassifier(int classes) : m_classes(classes) {}

  LabeledCloud answer(const LabeledCloud& truth) {
    LabeledCloud cloud;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth.classes[i] == semantic_types::kNoClass) continue;
      cloud.points.push_back(truth.points[i]);
      addRow(truth.classes[i], cloud.probabilities);
    }
    return cloud;
  }

 private:
  static constexpr double kSignal = 2;

  void addRow(ClassId truth, std::vector<float>& rows) {
    std::vector<double> odds;
    double sum = 0;
    for (int id = 1; id <= m_classes; ++id) {
      const double seen = (id == truth ? kSignal : 0) + m_noise(m_random);
      odds.push_back(std::exp(kSignal * seen));
      sum += odds.back();
    }
    for (const double o : odds) rows.push_back(static_cast<float>(o / sum));
  }

  int m_classes;
  std::mt19937 m_random{5};
  std::normal_distribution<> m_noise;
};

struct Comparison {
  double soft, hard, single;
};

/** Accuracy of maps of the even scans, asked for the points of the odd ones. */
Comparison compare(double resolution) {
  const ClassTable table =
      semantic_types::loadClassTable(MSO_SOURCE_DIR "/config/classes/synthetic.yaml");
  const auto frames = readSampleScans();
  LabelModel harden;
  harden.kind = LabelModel::Kind::Hard;
  ConfusedClassifier classifier(table.size());
  std::vector<LabeledCloud> soft, hard;
  double right = 0, points = 0;
  for (std::size_t f = 0; f < frames.size(); f += 2) {
    soft.push_back(classifier.answer(frames[f].cloud));
    hard.push_back(soft.back());
    harden.apply(table.size(), {}, hard.back());
    std::size_t next = 0;
    for (const ClassId id : frames[f].cloud.classes)
      if (id != semantic_types::kNoClass) right += hard.back().classes[next++] == id;
    points += double(hard.back().size());
  }
  semantic_octree::FilterParameters filter;
  filter.accuracy = right / points;  // so that hard labels are trusted as they deserve
  SemanticOcTree softMap(resolution, table, filter), hardMap(resolution, table, filter);
  for (std::size_t i = 0; i < soft.size(); ++i) {
    softMap.insert(soft[i], frames[2 * i].T_map_sensor);
    hardMap.insert(hard[i], frames[2 * i].T_map_sensor);
  }
  MapQuality softQuality, hardQuality;
  for (std::size_t f = 1; f < frames.size(); f += 2) {
    judge(softMap, frames[f], 15, softQuality);
    judge(hardMap, frames[f], 15, hardQuality);
  }
  return {softQuality.accuracy(), hardQuality.accuracy(), filter.accuracy};
}

}  // namespace

TEST(SoftLabels, ofAConfusedClassifierMakeABetterMapThanItsHardLabels) {
  const Comparison result = compare(0.5);
  RecordProperty("single", std::to_string(result.single));
  RecordProperty("soft", std::to_string(result.soft));
  RecordProperty("hard", std::to_string(result.hard));
  EXPECT_LT(result.single, 0.6);
  EXPECT_GT(result.soft, result.hard + 0.02);
}
