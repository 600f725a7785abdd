#include <gtest/gtest.h>

#include "Parameters.h"
#include "TemporaryFolder.h"
#include "ros2/Arguments.h"

using semantic_map_ros2::Parameters;
using semantic_map_ros2::readParameters;

namespace {

std::string problemOf(const std::vector<std::pair<std::string, std::string>>& values) {
  return errorOf([&] { readParameters({}, values); });
}

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
  EXPECT_TRUE(options.costsOf(4).empty());
  options.costs = "0, 40, 99";
  EXPECT_EQ(options.costsOf(3), (std::vector<int>{0, 40, 99}));
  EXPECT_TRUE(contains(errorOf([&] { options.costsOf(2); }), "there are 3"));
  options.costs = "0,101";
  EXPECT_TRUE(contains(errorOf([&] { options.costsOf(2); }), "'101'"));
}

ros2::Arguments argumentsOf(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return ros2::argumentsOf(static_cast<int>(argv.size()), argv.data());
}

}  // namespace

TEST(RosArguments, areBehindTheirFlagUntilTwoDashes) {
  const auto a =
      argumentsOf({"program", "-o", "x", "--ros-args", "-r", "a:=/b", "--param",
                   "p:=", "--params-file", "f", "--", "-q", "--ros-args", "-p", "s.t:=1"});
  EXPECT_EQ(a.problem, "");
  EXPECT_EQ(a.others.size(), 4u);
  EXPECT_EQ(std::string(a.others.back()), "-q");
  ASSERT_EQ(a.remappings.size(), 1u);
  EXPECT_EQ(a.remappings[0], std::make_pair(std::string("a"), std::string("/b")));
  ASSERT_EQ(a.parameters.size(), 2u);
  EXPECT_EQ(a.parameters[0].second, "");
  EXPECT_EQ(a.parameters[1].first, "s.t");
  EXPECT_EQ(a.files, std::vector<std::string>{"f"});
}

TEST(RosArguments, sayWhatIsWrong) {
  EXPECT_EQ(argumentsOf({"p", "--ros-args", "-r", "a=b"}).problem, "-r a=b: expected FROM:=TO");
  EXPECT_EQ(argumentsOf({"p", "--ros-args", "-p", ":=b"}).problem, "-p :=b: expected NAME:=VALUE");
  EXPECT_EQ(argumentsOf({"p", "--ros-args", "-p"}).problem, "-p lacks its value");
  EXPECT_NE(argumentsOf({"p", "--ros-args", "-x", "y"}).problem.find("unknown argument '-x'"),
            std::string::npos);
}
