#include <gtest/gtest.h>

#include <cmath>

#include <semantic_octree/ClassFilter.h>

using namespace semantic_octree;

TEST(FilterParameters, thatMakeNoSenseAreRefusedByName) {
  const auto refusal = [](int K, void (*change)(FilterParameters&)) -> std::string {
    FilterParameters p;
    change(p);
    try {
      ClassFilter<float> filter(K, p);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "accepted";
  };
  const auto names = [](const std::string& what, const char* name) {
    return what.find(name) != std::string::npos;
  };
  const auto unchanged = [](FilterParameters&) {};
  EXPECT_PRED2(names, refusal(0, unchanged), "number of classes = 0");
  EXPECT_PRED2(names, refusal(255, unchanged), "number of classes = 255");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = 0.2; }), "accuracy = 0.2");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = 1; }), "accuracy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = NAN; }), "accuracy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.hitProbability = 1; }),
               "hitProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.falseAlarmProbability = 0.6; }),
               "falseAlarmProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.falseAlarmProbability = 0; }),
               "falseAlarmProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0.5; }),
               "minOccupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0; }), "minOccupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.maxProbability = 0.5; }),
               "maxProbability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.softLabelFloor = 0; }),
               "softLabelFloor");
  EXPECT_EQ(refusal(1, [](FilterParameters& p) { p.accuracy = 0.5; }), "accepted");
  EXPECT_EQ(refusal(254, unchanged), "accepted");
}
