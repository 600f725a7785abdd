// What neighbors bring: maps of even frames, asked for the points of the odd ones.
#include <gtest/gtest.h>
#include <map_operations/SmoothedView.h>

#include <cmath>

#include "CountedLabels.h"
#include "DataSets.h"
#include "Evaluation.h"
#include "SharedData.h"

using semantic_map_evaluate::Evaluation;
using semantic_octree::SmoothedView;

namespace {

const double kWeight = semantic_octree::SmoothingOptions().neighborWeight;
constexpr std::size_t kEvery = 5;  // every fifth point is asked for: there are half a million

/** A map of the even frames with a share of wrong labels, and the same labels counted. */
struct NoisyMap {
  NoisyMap(const std::vector<LabeledFrame>& frames, const ClassTable& table, double resolution,
           double noise)
      : map(resolution, table) {
    std::mt19937 random(2);
    for (std::size_t i = 0; i < frames.size(); i += 2) {
      LabeledFrame frame = frames[i];
      disturb(frame.cloud.classes, noise, table.size(), random);
      map.insert(frame.cloud, frame.T_map_sensor);
      for (std::size_t k = 0; k < frame.cloud.size(); ++k)
        counted.add(voxelOf(map, frame, k), frame.cloud.classes[k]);
    }
  }

  SemanticOcTree map;
  CountedLabels counted;
};

/** Calls ask(frame, point, truth) for points of the odd frames. */
template <typename Ask>
void forEachAsked(const std::vector<LabeledFrame>& frames, const Ask& ask) {
  for (std::size_t i = 1; i < frames.size(); i += 2)
    for (std::size_t k = 0; k < frames[i].cloud.size(); k += kEvery) {
      const ClassId truth = frames[i].cloud.classes[k];
      if (truth != kNoClass && !frames[i].isMoving(k)) ask(frames[i], k, truth);
    }
}

Evaluation evaluate(const SemanticOcTree& map, double weight,
                    const std::vector<LabeledFrame>& frames) {
  const SmoothedView view(map, {weight});
  Evaluation evaluation(map.numClasses());
  forEachAsked(frames, [&](const LabeledFrame& frame, std::size_t k, ClassId truth) {
    evaluation.ask(view, frame.T_map_sensor * frame.cloud.points[k].cast<double>(), truth);
  });
  return evaluation;
}

/** Share of right answers where map and counting both have one: smoothed, and counted with the same
 * kernel. */
std::pair<double, double> besideCounting(const NoisyMap& noisy, double weight,
                                         const std::vector<LabeledFrame>& frames) {
  const SmoothedView view(noisy.map, {weight});
  double points = 0, right = 0, rightCounted = 0;
  forEachAsked(frames, [&](const LabeledFrame& frame, std::size_t k, ClassId truth) {
    const Voxel voxel = voxelOf(noisy.map, frame, k);
    const auto state = view.query(keyOf(voxel));
    if (state.status != semantic_octree::CellState::Status::Occupied || !noisy.counted.has(voxel))
      return;
    ++points;
    right += state.likeliestClass == truth;
    rightCounted += noisy.counted.at(voxel, weight) == truth;
  });
  return {right / points, rightCounted / points};
}

}  // namespace

TEST(SmoothedMap, seesThroughThirtyPercentOfWrongLabelsAsCountingDoesWithNeighborsAndWithout) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  for (const char* sequence : {"00", "07"}) {
    const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table);
    for (const double resolution : {0.1, 0.2}) {
      const NoisyMap noisy(frames, table, resolution, 0.3);
      const auto [own, ownCounted] = besideCounting(noisy, 0, frames);
      const auto [smoothed, smoothedCounted] = besideCounting(noisy, kWeight, frames);
      EXPECT_GE(own, ownCounted - 0.005) << sequence << " at " << resolution << " m";
      EXPECT_GE(smoothed, smoothedCounted - 0.005) << sequence << " at " << resolution << " m";
      EXPECT_GE(smoothed, 0.97) << sequence << " at " << resolution << " m";
      EXPECT_GE(smoothed, own + 0.015) << sequence << " at " << resolution << " m";
    }
  }
}

TEST(SmoothedMap, ofRightLabelsAnswersForVoxelsThatWereNotHitAndLosesNothing) {
  SKIP_WITHOUT_DATA("semantic_kitti");
  const ClassTable table = shippedTable("semantic_kitti.yaml");
  for (const char* sequence : {"00", "07"}) {
    const auto frames = readSemanticKitti(sharedDataDir() / "semantic_kitti" / sequence, table);
    for (const double resolution : {0.1, 0.2}) {
      const NoisyMap clean(frames, table, resolution, 0);
      const Evaluation own = evaluate(clean.map, 0, frames);
      const Evaluation smoothed = evaluate(clean.map, kWeight, frames);
      EXPECT_GE(smoothed.rightOfAll(), 0.96) << sequence << " at " << resolution << " m";
      EXPECT_GE(smoothed.rightOfAll(), own.rightOfAll() + 0.03);
      EXPECT_GE(smoothed.accuracy(), own.accuracy() - 0.0005);
      EXPECT_LE(smoothed.calibrationError(), 0.015);
      EXPECT_LE(smoothed.logLoss(), 0.13);
    }
  }
}

TEST(SmoothedMap, ofAFlatFillsGapsAndKeepsBordersWithinHalfAPoint) {
  SKIP_WITHOUT_DATA("replica_apartment_0");
  const ClassTable table = shippedTable("replica_apartment.yaml");
  auto frames = readReplica(sharedDataDir() / "replica_apartment_0");
  frames.resize(20);
  for (const double resolution : {0.1, 0.2}) {
    const NoisyMap clean(frames, table, resolution, 0);
    const Evaluation own = evaluate(clean.map, 0, frames);
    const Evaluation smoothed = evaluate(clean.map, kWeight, frames);
    EXPECT_GE(smoothed.accuracy(), own.accuracy() - 0.006) << resolution << " m";
    EXPECT_GE(smoothed.rightOfAll(), own.rightOfAll() + 0.004) << resolution << " m";
  }
}
