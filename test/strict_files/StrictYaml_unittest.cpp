#include <gtest/gtest.h>
#include <strict_files/StrictYaml.h>

#include "SomeOptions.h"
#include "TemporaryFolder.h"

using strict_files::StrictYaml;

namespace {

/** Reads options from a YAML file in which other keys are errors. */
class YamlOptions : public testing::Test {
 protected:
  some::Options read(const std::string& text) const {
    some::Options options;
    strict_files::OptionList list;
    options.describe(list);
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

}  // namespace

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
  EXPECT_TRUE(contains(refusal("length: 4\n---\nlength: 5\n"), ":2: a second document"))
      << refusal("length: 4\n---\nlength: 5\n");
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
