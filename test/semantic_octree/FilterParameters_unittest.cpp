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
  EXPECT_PRED2(names, refusal(0, unchanged), "number of classes is 0");
  EXPECT_PRED2(names, refusal(255, unchanged), "number of classes is 255");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = 0.2; }), "accuracy is 0.2");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = 1; }), "accuracy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.accuracy = NAN; }), "accuracy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.labelCorrelation = -0.01; }),
               "label_correlation");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.labelCorrelation = 1.01; }),
               "label_correlation");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.labelCorrelation = NAN; }),
               "label_correlation");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.hitProbability = 1; }),
               "hit_probability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.falseAlarmProbability = 0.6; }),
               "false_alarm_probability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.falseAlarmProbability = 0; }),
               "false_alarm_probability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0.5; }),
               "min_occupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0; }), "min_occupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.maxProbability = 0.5; }),
               "max_probability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.softLabelFloor = 0; }),
               "soft_label_floor");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.hitProbability = 1 - 0.99e-9; }),
               "hit_probability");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.minOccupancy = 0.99e-9; }),
               "min_occupancy");
  EXPECT_PRED2(names, refusal(5, [](FilterParameters& p) { p.maxProbability = 1 - 0.99e-9; }),
               "max_probability");
  EXPECT_EQ(refusal(1, [](FilterParameters& p) { p.accuracy = 0.5; }), "accepted");
  EXPECT_EQ(refusal(254, unchanged), "accepted");
  EXPECT_EQ(refusal(254, [](FilterParameters& p) { p.labelCorrelation = 0; }), "accepted");
  EXPECT_EQ(refusal(254, [](FilterParameters& p) { p.labelCorrelation = 1; }), "accepted");
  EXPECT_EQ(refusal(254, [](FilterParameters& p) { p.minOccupancy = 1e-9; }), "accepted");
  EXPECT_EQ(refusal(254, [](FilterParameters& p) { p.hitProbability = 1 - 1e-9; }), "accepted");
  EXPECT_EQ(refusal(254, [](FilterParameters& p) { p.maxProbability = 1 - 1e-9; }), "accepted");
}
