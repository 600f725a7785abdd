#include <gtest/gtest.h>
#include <view_information/GainField.h>

#include <algorithm>
#include <cmath>

#include "ThreeClasses.h"

using namespace view_information;
using semantic_octree::kKeyOfOrigin;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kGroundKey = kKeyOfOrigin, kOrigin = kKeyOfOrigin;

/** Road to the east (x > 0), grass to the west, each known up to 6 m; nothing else is. */
struct TwoSides {
  SemanticOcTree map{kVoxel, threeClasses()};
  Question question;
  GainField field;
  ViewTemplate view{{8, -45, 15, 80}, kVoxel};

  explicit TwoSides(ClassId relevant) : question(relevantOnly(relevant), 3), field(map, question) {}
  void teach(LearnedPrior& prior) const {
    for (int x = -30; x < 30; ++x)
      for (int y = -8; y < 8; ++y)
        prior.learn(kOrigin + x, kOrigin + y, kGroundKey, x < 0 ? kGrass : kRoad);
  }
  /** The gain of a view to the east from the border there, less that of a view to the west. */
  double eastBeforeWest(UnknownPrior& prior) {
    constexpr int kEast = ViewTemplate::kHeadings / 2, kWest = 0;
    const auto at = [](int x) {
      return semantic_octree::octomapKey(kOrigin + x, kOrigin, kGroundKey + 6);
    };
    return gainOfHeading(field.sweep(view, prior, at(28)), kEast, 80) -
           gainOfHeading(field.sweep(view, prior, at(-29)), kWest, 80);
  }
};

}  // namespace

TEST(UnknownPrior, withoutALearnedOneWeightsBringNothing) {
  for (const ClassId relevant : {kRoad, kGrass}) {
    TwoSides sides(relevant);
    const BeamModel model(3, sides.map.filterParameters());
    UniformPrior uniform(sides.question, model);
    EXPECT_NEAR(sides.eastBeforeWest(uniform), 0, 0.05);
  }
  TwoSides road(kRoad), grass(kGrass);
  const BeamModel model(3, road.map.filterParameters());
  UniformPrior a(road.question, model), b(grass.question, model);
  EXPECT_EQ(a.patch(0, 0).above.gain, b.patch(0, 0).above.gain);
}

TEST(UnknownPrior, groundThatIsRelevantForSureIsWorthMost) {
  TwoSides sides(kRoad);
  LearnedPrior prior(sides.map, sides.question);
  sides.teach(prior);
  const auto worthAt = [&](int x) {
    return prior.patch((kOrigin + x) / 4, (kOrigin + 10) / 4).onGround.gain;
  };
  EXPECT_GT(worthAt(20), 1.2F * worthAt(0));
  EXPECT_GT(worthAt(0), 1.2F * worthAt(-20));
}

TEST(UnknownPrior, groundGoesOnAndIsOneVoxelThick) {
  TwoSides sides(kRoad);
  LearnedPrior prior(sides.map, sides.question);
  sides.teach(prior);
  const UnknownPatch& east = prior.patch((kOrigin + 34) / 4, kOrigin / 4);
  EXPECT_EQ(east.ground, kGroundKey);
  const int x = kOrigin + 34, y = kOrigin;
  EXPECT_GT(east.at(x, y, kGroundKey).gain, 1.2F * east.at(x, y, kGroundKey + 1).gain);
  EXPECT_LT(east.at(x, y, kGroundKey).pass, 0.2);
  EXPECT_EQ(east.at(x, y, kGroundKey - 1).gain, 0);
  EXPECT_EQ(east.at(x, y, kGroundKey - 1).pass, 0);
  EXPECT_EQ(east.at(x, y, kGroundKey + 40).gain, 0);
}

TEST(UnknownPrior, knownGroundHidesWhatIsBelowIt) {
  TwoSides sides(kRoad);
  LearnedPrior prior(sides.map, sides.question);
  sides.teach(prior);
  const UnknownPatch& known = prior.patch(kOrigin / 4, kOrigin / 4);
  EXPECT_EQ(known.grounded, 0xFFFF);
  EXPECT_EQ(known.at(kOrigin, kOrigin, kGroundKey).gain, 0);
}

TEST(UnknownPrior, whoLooksOnChangesNothingOfIt) {
  TwoSides sides(kRoad);
  LearnedPrior seen(sides.map, sides.question), alone(sides.map, sides.question);
  for (const int x : {-400, 20, 400}) seen.lookAt((kOrigin + x) / 4, kOrigin / 4);
  EXPECT_EQ(seen.memoryUsage(), alone.memoryUsage());
  sides.teach(seen), sides.teach(alone);
  for (const int x : {-400, 20, 400}) {
    const int px = (kOrigin + x) / 4, py = kOrigin / 4;
    const float looked = seen.lookAt(px, py).onGround.gain;
    EXPECT_EQ(seen.patch(px, py).onGround.gain, alone.patch(px, py).onGround.gain) << x;
    if (x != 20) {
      EXPECT_EQ(looked, alone.patch(px, py).onGround.gain) << x;
    }
  }
}

TEST(UnknownPrior, groundThatChangesItsClassChangesWhatIsNear) {
  TwoSides sides(kRoad);
  LearnedPrior prior(sides.map, sides.question);
  sides.teach(prior);
  const int px = (kOrigin - 34) / 4, py = kOrigin / 4;
  const float before = prior.patch(px, py).onGround.gain;
  for (int x = -30; x < 0; ++x)
    for (int y = -8; y < 8; ++y) prior.learn(kOrigin + x, kOrigin + y, kGroundKey, kRoad);
  EXPECT_GT(prior.patch(px, py).onGround.gain, before);
}

TEST(UnknownPrior, whatStandsOnGroundIsExpectedOnSuchGround) {
  TwoSides sides(kWall);
  semantic_types::LabeledCloud cloud;  // 2 m high, along the grass at x = -3.1
  for (int i = -20; i < 20; ++i)
    for (int j = 1; j < 20; ++j) {
      cloud.points.emplace_back(-3.1F, 0.1F * static_cast<float>(i), 0.1F * static_cast<float>(j));
      cloud.classes.push_back(kWall);
    }
  for (int i = 0; i < 4; ++i) sides.map.insert(cloud, Eigen::Isometry3d::Identity());
  LearnedPrior prior(sides.map, sides.question);
  sides.teach(prior);
  const float grass = prior.patch((kOrigin - 34) / 4, kOrigin / 4).above.gain;
  const float road = prior.patch((kOrigin + 34) / 4, kOrigin / 4).above.gain;
  EXPECT_GT(grass, 2 * road);
}
