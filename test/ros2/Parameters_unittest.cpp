#include "Parameters.h"

#include <gtest/gtest.h>

#include "TemporaryFolder.h"

using semantic_map_ros2::Parameters;
using semantic_map_ros2::readParameters;

namespace {

std::string problemOf(const std::vector<std::pair<std::string, std::string>>& values) {
  return errorOf([&] { readParameters({}, values); });
}

}  // namespace

TEST(RosParameters, haveRosForms) {
  const TemporaryFolder folder;
  const auto ros = folder.write("ros.yaml", R"(
/**:
  ros__parameters: {slam: true, insertion.max_range: 30.0, class_field: id}
other_node:
  ros__parameters: {slam: false, unknown_there: 3}
semantic_map:
  ros__parameters:
    class_field: segment
    movers: {classes: [person, dog]}
    order: orders/a.yaml
)");
  const Parameters p = readParameters({ros}, {{"insertion.max_range", "20"}, {"order", "b.yaml"}});
  EXPECT_TRUE(p.node.slam);
  EXPECT_EQ(p.node.classField, "segment");
  EXPECT_EQ(p.insertion.scan.maxRange, 20);
  EXPECT_EQ(p.navigation.movers.classes, "person, dog");
  EXPECT_EQ(p.node.order, "b.yaml");
  EXPECT_EQ(readParameters({ros}, {}).node.order, (folder / "orders/a.yaml").string());
  const auto plain = folder.write("plain.yaml", "slam: true\nslam.level: true\n");
  EXPECT_TRUE(readParameters({plain}, {}).slam.level);
}

TEST(RosParameters, refuseWhatTheyDoNotKnow) {
  EXPECT_TRUE(contains(problemOf({{"slm", "true"}}), "did you mean 'slam'"));
  EXPECT_TRUE(contains(problemOf({{"insertion.max_rnge", "3"}}), "did you mean 'max_range'"));
  EXPECT_TRUE(contains(problemOf({{"insertions.max_range", "3"}}), "insertions"));
  EXPECT_TRUE(contains(problemOf({{"publish_period", "-1"}}), "publish_period"));
  EXPECT_TRUE(contains(problemOf({{"drive", "true"}}), "drive.reactive"));
  EXPECT_TRUE(
      contains(errorOf([] { readParameters({"no-such-file.yaml"}, {}); }), "no-such-file.yaml"));
}

TEST(RosParameters, costsAreOfRanks) {
  semantic_map_ros2::NodeOptions options;
  EXPECT_EQ(options.costsOf(4), (std::vector<int>{0, 30, 60, 90}));
  EXPECT_EQ(options.costsOf(1), std::vector<int>{0});
  options.costs = "0, 40, 99";
  EXPECT_EQ(options.costsOf(3), (std::vector<int>{0, 40, 99}));
  EXPECT_TRUE(contains(errorOf([&] { options.costsOf(2); }), "there are 3"));
  options.costs = "0,101";
  EXPECT_TRUE(contains(errorOf([&] { options.costsOf(2); }), "'101'"));
}
