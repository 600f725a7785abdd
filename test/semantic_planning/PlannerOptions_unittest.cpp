#include <gtest/gtest.h>
#include <semantic_planning/planner/SemanticPlanner.h>

#include <set>

using namespace semantic_planning;

namespace {

template <class E>
void expectNames(std::size_t count) {
  std::set<std::string> names;
  for (const auto& [name, value] : choicesOf(E())) {
    EXPECT_STREQ(strict_files::nameIn(choicesOf(E()), value), name);
    names.insert(name);
  }
  EXPECT_EQ(names.size(), count);
}

}  // namespace

TEST(PlannerOptions, haveNamesOfTheirOwn) {
  PlannerOptions options;
  const auto list = strict_files::OptionList::of(options);
  const std::vector<std::string> names = list.names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(PlannerOptions, areSetByTheirNames) {
  PlannerOptions options;
  const auto list = strict_files::OptionList::of(options);
  const auto set = [&](const char* name, const char* text) { list.find(name)->set(text); };
  set("graph", "full");
  set("vertices", "700");
  set("reading", "cautious");
  set("fillGap", "0.3");
  set("keep_off", "true");
  EXPECT_EQ(options.roadmap.kind, GraphKind::Full);
  EXPECT_EQ(options.roadmap.vertices, 700u);
  EXPECT_EQ(options.reading.kind, ClassReading::Kind::Cautious);
  EXPECT_EQ(options.ground.fillGap, 0.3);
  EXPECT_TRUE(options.ground.keepOff);
  EXPECT_NO_THROW(options.validate());
}

TEST(PlannerOptions, choicesHaveNamesOfTheirOwn) {
  expectNames<GraphKind>(5);
  expectNames<ClassReading::Kind>(3);
  expectNames<PlanStatus>(10);
}
