#include <gtest/gtest.h>
#include <strict_files/Words.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "CommaHost.h"
#include "Readers.h"

namespace fs = std::filesystem;

namespace {

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> filesOf(const Reader& reader) {
  std::vector<std::string> contents;
  for (const std::string& example : reader.examples)
    contents.push_back(contentOf(fs::path(MSO_SOURCES) / example));
  const fs::path corpus = fs::path(MSO_SOURCES) / "test/fuzz/corpus" / reader.name;
  if (fs::exists(corpus))
    for (const auto& entry : fs::directory_iterator(corpus))
      contents.push_back(contentOf(entry.path()));
  return contents;
}

/** What a reader says if it refuses them. */
std::string expectAnswer(const Reader& reader, const std::string& bytes) {
  try {
    reader.read(bytes);
    return {};
  } catch (const std::exception& e) {
    EXPECT_STRNE(e.what(), "") << reader.name;
    return strict_files::messageOf(e);
  }
}

}  // namespace

TEST(Readers, haveEachANameOfItsOwn) {  // or fuzzing would meet the first alone
  std::set<std::string> names;
  for (const Reader& reader : readers())
    EXPECT_TRUE(names.insert(reader.name).second) << reader.name;
}

TEST(Readers, takeOneOfTheirFilesAtLeast) {  // or fuzzing would end where they begin
  for (const Reader& reader : readers()) {
    std::string refusals;
    bool isTaken = false;
    for (const std::string& bytes : filesOf(reader)) {
      const std::string refusal = expectAnswer(reader, bytes);
      isTaken |= refusal.empty();
      refusals += refusal + '\n';
    }
    EXPECT_TRUE(isTaken) << reader.name << ":\n" << refusals;
  }
}

/** To each file that ever broke one. */
TEST(Readers, answerTheSameInAHostWithDecimalCommas) {
  for (const Reader& reader : readers()) {
    expectAnswer(reader, "");
    for (const std::string& bytes : filesOf(reader)) {
      const std::string answer = expectAnswer(reader, bytes);
      const CommaHost host;
      EXPECT_EQ(expectAnswer(reader, bytes), answer) << reader.name;
    }
  }
}

TEST(Readers, answerToFilesThatAreCutOrAltered) {
  std::mt19937 random(1);
  for (const Reader& reader : readers())
    for (const std::string& bytes : filesOf(reader)) {
      SCOPED_TRACE(reader.name);
      for (int i = 0; i < 40; ++i) {
        std::string altered = bytes.substr(0, i % 4 == 0 ? random() % bytes.size() : bytes.size());
        for (int flips = i % 5; flips > 0 && !altered.empty(); --flips)
          altered[random() % altered.size()] = static_cast<char>(random());
        expectAnswer(reader, altered);
      }
    }
}
