// What soft labels are worth, with a classifier that confuses classes but knows how sure it is.
#include <gtest/gtest.h>
#include <labeled_cloud/LabelModel.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_types/ClassTable.h>

#include <cmath>
#include <random>

#include "MapQuality.h"
#include "SampleScans.h"

using labeled_cloud::LabelModel;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::ClassTable;
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
