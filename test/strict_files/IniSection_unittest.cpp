#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <strict_files/IniSection.h>
#include <strict_files/StrictYaml.h>

#include <cmath>
#include <map>

#include "SomeOptions.h"
#include "TemporaryFolder.h"

using some::Options;
using strict_files::checkSections;
using strict_files::readSection;

namespace {

/** As MRPT's readers of .ini files, without MRPT. */
struct Source {
  std::map<std::string, std::map<std::string, std::string>> sections;

  void getAllSections(std::vector<std::string>& names) const {
    names.clear();
    for (const auto& [name, keys] : sections) names.push_back(name);
  }
  void getAllKeys(const std::string& section, std::vector<std::string>& keys) const {
    keys.clear();
    if (sections.count(section))
      for (const auto& [key, value] : sections.at(section)) keys.push_back(key);
  }
  std::string read_string(const std::string& section, const std::string& key,
                          const std::string&) const {
    return sections.at(section).at(key);
  }
};

Options optionsOf(const std::map<std::string, std::string>& keys) {
  Options options;
  readSection(Source{{{"part", keys}}}, "part", options);
  return options;
}

std::string refusal(const std::map<std::string, std::string>& keys) {
  return errorOf([&] { optionsOf(keys); });
}

TEST(IniSection, keysThatAreAbsentLeaveTheirOptionAsItIs) {
  const Options options = optionsOf({{"length", "4"}});
  EXPECT_EQ(options.length, 4);
  EXPECT_EQ(options.count, 3);
  EXPECT_EQ(options.title, "a title");
}

TEST(IniSection, commentsBehindValuesAreLeftOut) {
  EXPECT_EQ(optionsOf({{"length", "4   // m"}}).length, 4);
  EXPECT_EQ(optionsOf({{"length", "4 # m"}}).length, 4);
  EXPECT_EQ(optionsOf({{"length", "4\t; m"}}).length, 4);
  EXPECT_EQ(optionsOf({{"title", "// nothing"}}).title, "");
  EXPECT_EQ(optionsOf({{"title", "http://a#b;c // d"}}).title, "http://a#b;c");
}

TEST(IniSection, anUnknownKeyIsNamedWithTheNearestKnownOne) {
  EXPECT_EQ(refusal({{"max_gab", "5"}}), "[part] unknown key 'max_gab'; did you mean 'max_gap'?");
}

TEST(IniSection, aBadValueIsNamedWithItsSectionAndKey) {
  EXPECT_EQ(refusal({{"count", "many"}}),
            "[part] count is 'many', expected a whole number of 1 or more");
  EXPECT_EQ(refusal({{"length", "-1"}}), "[part] length is -1, expected a number above 0 up to 10");
}

TEST(IniSection, anUnknownSectionIsNamedWithTheNearestKnownOne) {
  const std::vector<std::string> known = {"map", "insertion", "camera *"};
  const auto refusalOf = [&](const std::string& section) {
    return errorOf([&] { checkSections(Source{{{section, {{"key", "1"}}}}}, known); });
  };
  EXPECT_EQ(refusalOf("map"), "");
  EXPECT_EQ(refusalOf("Map"), "");
  EXPECT_EQ(refusalOf("camera front"), "");
  EXPECT_EQ(refusalOf("inserting"),
            "[inserting] unknown section 'inserting'; did you mean 'insertion'?");
  EXPECT_NE(refusalOf("maps"), "");
  EXPECT_NE(refusalOf("camera"), "");
  EXPECT_NE(refusalOf(""), "");
  EXPECT_EQ(errorOf([&] { checkSections(Source{{{"", {}}}}, known); }), "");
}

TEST(IniText, holdsNothingThatMrptWouldLeaveOut) {
  EXPECT_EQ(
      errorOf([] {
        strict_files::checkIniText(
            "# c\n; c\n// c\n\n[a b]\nk = 1\nlong = 1 \\\n 2 3\nempty =\n[other]\nk = 2 // c\n");
      }),
      "");
  for (const auto& [text, words] : std::map<std::string, std::string>{
           {"[a]\nk 1\n", "line 2: 'k 1', expected key = value"},
           {"[a]\nk = 1\n\nK=2\n", "line 4: key 'K' twice"},
           {"[a]\nmax_gap = 1\nmaxGap = 2\n", "line 3: key 'maxGap' twice"},
           {"[a\n", "line 1: '[a' has no ']'"},
           {"= 3\n", "line 1: '= 3', expected key = value"}})
    EXPECT_EQ(errorOf([&, &ini = text] { strict_files::checkIniText(ini); }), words);
}

using strict_files::StrictYaml;

/** Reads options from a YAML file in which other keys are errors. */
class YamlOptions : public testing::Test {
 protected:
  some::Options read(const std::string& text) const {
    some::Options options;
    const auto list = strict_files::OptionList::of(options);
    const StrictYaml yaml(folder.write("o.yaml", text));
    const auto names = list.names();
    yaml.checkKeys(yaml.root(), {names.begin(), names.end()});
    yaml.read(yaml.root(), list);
    return options;
  }
  /** Without the folder's path. */
  std::string refusal(const std::string& text) const {
    const std::string error = errorOf([&] { read(text); });
    const std::string path = (folder / "o.yaml").string();
    return error.rfind(path, 0) == 0 ? error.substr(path.size()) : "unnamed file: " + error;
  }

  const TemporaryFolder folder;
};

TEST_F(YamlOptions, areReadFromAMap) {
  const auto options =
      read("length: 4\ncolor: dark_red\nplace: [4, 5, 6.5]\non: false\nfloor: -2\n");
  EXPECT_EQ(options.length, 4);
  EXPECT_EQ(options.color, some::Color::DarkRed);
  EXPECT_EQ(options.place, Eigen::Vector3d(4, 5, 6.5));
  EXPECT_FALSE(options.on);
  EXPECT_EQ(options.floor, -2);
  EXPECT_EQ(options.count, 3);
}

TEST_F(YamlOptions, badValuesAreNamedWithFileLineAndKey) {
  EXPECT_EQ(refusal("length: 1\ncount: 0\n"),
            ":2: count is 0, expected a whole number of 1 or more");
  EXPECT_EQ(refusal("place: [1, 2]\n"), ":1: place is '1, 2', expected three numbers x, y, z");
  EXPECT_EQ(refusal("count: {a: 1}\n"), ":1: count: expected a word");
}

TEST_F(YamlOptions, unknownAndRepeatedKeysAreNamed) {
  EXPECT_EQ(refusal("\nlenght: 4\n"), ":2: unknown key 'lenght'; did you mean 'length'?");
  EXPECT_EQ(refusal("length: 4\nlength: 5\n"), ":2: key 'length' twice");
  EXPECT_EQ(refusal("- 1\n"), ":1: expected 'key: value' entries");
}

TEST_F(YamlOptions, whatIsNoYamlIsNamedWithItsLine) {
  EXPECT_EQ(refusal("length: 4\ncolor: [1\n").rfind(":3: ", 0), 0u)
      << refusal("length: 4\ncolor: [1\n");
  EXPECT_TRUE(
      contains(errorOf([&] { StrictYaml(folder / "none.yaml"); }), "none.yaml: cannot be read"));
  EXPECT_TRUE(contains(errorOf([&] { StrictYaml(folder.path()); }), "cannot be read"));
}

TEST_F(YamlOptions, aSecondDocumentIsRefused) {
  EXPECT_TRUE(contains(refusal("length: 4\n---\nlength: 5\n"), ":2: a second document"));
  EXPECT_TRUE(contains(refusal("# c\n---\nlength: 4\n--- # c\n"), ":4: a second document"));
  EXPECT_EQ(read("# c\n\n---\nlength: 4\n").length, 4);
}

TEST_F(YamlOptions, singleValuesAreChecked) {
  const StrictYaml yaml(folder.write("v.yaml", "a: 1\nb: -1\nc: .inf\nd: [1, 2, 3]\ne: []\n"));
  const YAML::Node& root = yaml.root();
  EXPECT_EQ(yaml.number(root["a"], "a"), 1);
  EXPECT_EQ(yaml.notNegative(root["a"], "a"), 1);
  EXPECT_EQ(yaml.point(root["d"], "d"), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(
      contains(errorOf([&] { yaml.notNegative(root["b"], "b"); }), "v.yaml:2: b: expected"));
  EXPECT_TRUE(contains(errorOf([&] { yaml.number(root["c"], "c"); }), "v.yaml:3: c: expected"));
  EXPECT_TRUE(contains(errorOf([&] { yaml.number(root["d"], "d"); }), "something else"));
  EXPECT_TRUE(
      contains(errorOf([&] { yaml.checkList(root["e"], "e"); }), "v.yaml:5: e: expected a list"));
  EXPECT_TRUE(contains(errorOf([&] { yaml.required(root, "f"); }), "key 'f' is missing"));
}

using some::Color;
using strict_files::Option;
using strict_files::OptionList;

/** What setting an option to this text fails with; empty: it does not. */
std::string refusal(const std::string& name, const std::string& text) {
  Options options;
  const OptionList list = OptionList::of(options);
  return errorOf([&] { list.find(name)->set(text); });
}

}  // namespace

TEST(OptionList, anOptionIsFoundHoweverItsWordsAreParted) {
  Options options;
  const OptionList list = OptionList::of(options);
  for (const char* name : {"max_gap", "maxGap", "max-gap", "MAXGAP"}) {
    ASSERT_TRUE(list.find(name)) << name;
    EXPECT_EQ(list.find(name)->name, "max_gap");
  }
  EXPECT_FALSE(list.find("maximal_gap"));
}

TEST(OptionList, endsOfARangeAreAllowedOrNot) {
  EXPECT_EQ(refusal("length", "10"), "");
  EXPECT_EQ(refusal("length", "0"), "is 0, expected a number above 0 up to 10");
  EXPECT_NE(refusal("length", "10.001"), "");
  EXPECT_EQ(refusal("floor", "4.999"), "");
  EXPECT_NE(refusal("floor", "5"), "");
  EXPECT_EQ(refusal("max_gap", "inf"), "");
  EXPECT_NE(refusal("max_gap", "-inf"), "");
  EXPECT_NE(refusal("length", "inf"), "");
  EXPECT_EQ(refusal("small", "255"), "");
  EXPECT_NE(refusal("small", "256"), "");
}

TEST(OptionList, whatIsNoValueIsRefusedAndChangesNothing) {
  Options options;
  const OptionList list = OptionList::of(options);
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"length", ""},
                                                        {"length", "2 m"},
                                                        {"length", "nan"},
                                                        {"count", "1.5"},
                                                        {"count", "x"},
                                                        {"on", "maybe"},
                                                        {"color", "red"},
                                                        {"floor", "low"},
                                                        {"place", "1, 2"},
                                                        {"place", "1,2,3,4"},
                                                        {"place", "1, 2, x"}}) {
    const std::string error =
        errorOf([&, &name = name, &text = text] { list.find(name)->set(text); });
    EXPECT_EQ(error.rfind("is ", 0), 0u) << name << " = " << text << ": " << error;
  }
  Options fresh;
  const OptionList untouched = OptionList::of(fresh);
  for (const Option& option : list.options())
    EXPECT_EQ(option.text(), untouched.find(option.name)->text()) << option.name;
}

TEST(OptionList, valuesOfStructsAreCheckedAndNamed) {
  Options options;
  EXPECT_NO_THROW(options.validate());
  options.count = 0;
  EXPECT_EQ(errorOf([&] { options.validate(); }),
            "Options::count is 0, expected a whole number of 1 or more");
  options = {};
  options.length = NAN;
  EXPECT_NE(errorOf([&] { options.validate(); }), "");
  options = {};
  options.floor = 6;
  EXPECT_NE(errorOf([&] { options.validate(); }), "");
  options = {};
  options.place.y() = INFINITY;
  EXPECT_NE(errorOf([&] { options.validate(); }), "");
}

TEST(OptionList, aRemovedOptionIsNotThere) {
  Options options;
  OptionList list = OptionList::of(options);
  list.remove("count");
  EXPECT_FALSE(list.find("count"));
  EXPECT_EQ(list.names().size(), 9u);
}

RC_GTEST_PROP(OptionList, textsAreReadBackWithoutLoss,
              (double length, double gap, int count, std::uint8_t small, bool on)) {
  Options options, read;
  options.length = 10 / (1 + std::fabs(length));
  options.gap = std::fabs(gap);
  options.count = std::max(1, count);
  options.small = small;
  options.on = on;
  options.color = on ? Color::DarkRed : Color::Green;
  if (length < 5) options.floor = length;
  options.place = {length, gap, -length};
  const OptionList from = OptionList::of(options), to = OptionList::of(read);
  for (const Option& option : from.options()) to.find(option.name)->set(option.text());
  RC_ASSERT(read.length == options.length);
  RC_ASSERT(read.gap == options.gap);
  RC_ASSERT(read.count == options.count);
  RC_ASSERT(read.small == options.small);
  RC_ASSERT(read.on == options.on);
  RC_ASSERT(read.color == options.color);
  RC_ASSERT(read.floor == options.floor);
  RC_ASSERT(read.place == options.place);
}

RC_GTEST_PROP(OptionList, numbersAreWrittenWithAsManyDigitsAsTheyNeed, (double number)) {
  RC_ASSERT(strict_files::numberOf(strict_files::textOf(number)) == number);
}

TEST(OptionList, numbersAreWrittenAsPeopleDo) {
  EXPECT_EQ(strict_files::textOf(100000), "100000");
  EXPECT_EQ(strict_files::textOf(-3), "-3");
  EXPECT_EQ(strict_files::textOf(0.1), "0.1");
  EXPECT_EQ(strict_files::textOf(1e300), "1e+300");
}

TEST(OptionList, infiniteNumbersKeepTheirSign) {
  EXPECT_EQ(strict_files::numberOf("inf"), INFINITY);
  EXPECT_EQ(strict_files::numberOf("-inf"), -INFINITY);
}
