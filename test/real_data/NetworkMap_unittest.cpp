// A real network on the pictures of a real street, through the programs.
#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/Rawlogs.h>
#include <semantic_types/ClassTable.h>

#include <fstream>
#include <iterator>

#include "CountedLabels.h"
#include "DataSets.h"
#include "RunProgram.h"
#include "SharedData.h"
#include "TemporaryFolder.h"

using labeled_cloud::CObservationLabeledCloud;
using labeled_cloud::ConfusionMatrix;
using labeled_cloud::LabelModel;
using semantic_types::LabeledCloud;

namespace {

const std::filesystem::path kConfig = std::filesystem::path(MSO_SOURCE_DIR) / "config";
constexpr double kResolution = 0.2;

ClassTable kittiTable() { return shippedTable("semantic_kitti.yaml"); }

/** The scans with the network's soft labels, as the programs save them. */
std::vector<LabeledCloud> labelByNetwork(const TemporaryFolder& folder) {
  const std::string scans = (folder / "scans.rawlog").string();
  const std::string labeled = (folder / "labeled.rawlog").string();
  succeeded(runProgram("dataset2rawlog",
                       {"semantic-kitti", (sharedDataDir() / "semantic_kitti/00").string(),
                        "--no-labels", "--images", "-o", scans}));
  succeeded(runProgram(
      "rawlog2semantic-map",
      {"--config", (kConfig / "maps/semantic-kitti.ini").string(), "--output",
       (folder / "out").string(), "--network",
       (sharedDataDir() / "networks/fchardnet_kitti.onnx").string(), "--network-config",
       (kConfig / "networks/fchardnet_kitti.yaml").string(), "--save-labeled", labeled, scans}));
  std::vector<LabeledCloud> clouds;
  labeled_cloud::RawlogReader reader(labeled);
  while (const auto entry = reader.next())
    for (const auto& o : entry->observations)
      if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(o.get()))
        clouds.push_back(cloud->cloud);
  return clouds;
}

/** The network's own, which calls one class otherwise. */
ConfusionMatrix networkConfusion(const TemporaryFolder& folder) {
  std::ifstream in(sharedDataDir() / "networks/confusion.json");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text.insert(text.find('{') + 1, R"("fold": {"bus": "other-vehicle"}, )");
  return labeled_cloud::loadConfusionMatrix(folder.write("confusion.json", text), kittiTable());
}

struct Result {
  double singleFrames = 0, map = 0;
};

/** Counts the points that the network labeled, that have a true class and do not move. How many are
 * right in single frames, and in the map that the labels make under this model? */
Result judgeModel(const std::vector<LabeledFrame>& truth, const std::vector<LabeledCloud>& clouds,
                  const LabelModel& model) {
  SemanticOcTree map(kResolution, kittiTable());
  if (model.confusion) map.setClassPrior(model.confusion->classShares());
  LabelModel hard;
  hard.kind = LabelModel::Kind::Hard;
  std::vector<std::vector<ClassId>> answers;
  for (std::size_t f = 0; f < clouds.size(); ++f) {
    LabeledCloud cloud = clouds[f], answered = clouds[f];
    model.apply(map.numClasses(), {}, cloud);
    hard.apply(map.numClasses(), {}, answered);
    answers.push_back(answered.classes);
    map.insert(cloud, truth[f].T_map_sensor);
  }
  double points = 0;
  Result right;
  for (std::size_t f = 0; f < truth.size(); ++f)
    for (std::size_t i = 0; i < truth[f].cloud.size(); ++i) {
      const ClassId own = truth[f].cloud.classes[i];
      if (own == kNoClass || truth[f].isMoving(i) || answers[f][i] == kNoClass) continue;
      const Eigen::Vector3d p = truth[f].T_map_sensor * truth[f].cloud.points[i].cast<double>();
      points += 1;
      right.singleFrames += answers[f][i] == own;
      right.map += map.query(p.x(), p.y(), p.z()).likeliestClass == own;
    }
  return {right.singleFrames / points, right.map / points};
}

}  // namespace

TEST(NetworkMap, isRightForMorePointsThanTheNetworkIsInSingleFrames) {
  SKIP_WITHOUT_DATA("semantic_kitti/00/image_2");
  SKIP_WITHOUT_DATA("networks/fchardnet_kitti.onnx");
  const TemporaryFolder folder;
  const auto clouds = labelByNetwork(folder);
  const auto truth = readSemanticKitti(sharedDataDir() / "semantic_kitti/00", kittiTable());
  ASSERT_EQ(clouds.size(), truth.size());
  LabelModel soft, hard, confused;
  hard.kind = confused.kind = LabelModel::Kind::Hard;
  confused.confusion = std::make_shared<ConfusionMatrix>(networkConfusion(folder));
  for (const auto& [name, model] :
       {std::pair("soft", soft), std::pair("hard", hard), std::pair("confusion", confused)}) {
    const Result result = judgeModel(truth, clouds, model);
    RecordProperty(std::string(name) + "_single", std::to_string(result.singleFrames));
    RecordProperty(std::string(name) + "_map", std::to_string(result.map));
    // The network errs in the same patches scan after scan: hard votes gain nothing by being many.
    const double tolerance = name == std::string("hard") ? 0.005 : 0;
    EXPECT_GT(result.map, result.singleFrames - tolerance) << name;
  }
}
