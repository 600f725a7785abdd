#include <gtest/gtest.h>
#include <strict_files/IniSection.h>

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

}  // namespace

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
