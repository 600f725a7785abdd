#include "ros2/Arguments.h"

#include <gtest/gtest.h>

namespace {

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
