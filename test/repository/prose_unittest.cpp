// How much there is to read, and how long the sentences are.
#include <gtest/gtest.h>

#include <iostream>

#include "ProseRules.h"
#include "SourceTree.h"

namespace fs = std::filesystem;

namespace {

const fs::path kSources = MSO_SOURCE_DIR;

/** The README and the pages of doc/, without studies, which are frozen, and the page of options,
 * which is written by a program. */
std::vector<fs::path> pages() {
  std::vector<fs::path> pages = {kSources / "README.md"};
  for (const fs::path& file : textFiles(kSources / "doc"))
    if (file.extension() == ".md" && file.filename() != "options.md" &&
        file.parent_path().filename() != "studies")
      pages.push_back(file);
  return pages;
}

/** Names the pages of a folder that have more words than that. */
void nameLongPages(const fs::path& folder, std::size_t most) {
  for (const fs::path& file : textFiles(folder)) {
    if (file.extension() != ".md" || file.filename() == "options.md") continue;
    const std::size_t words = countWords(textOf(file));
    if (words > most)
      std::cout << "warning: " << file.lexically_relative(kSources).string() << " has " << words
                << " words, more than " << most << '\n';
  }
}

}  // namespace

TEST(Prose, ofAllPagesHasAtMostThirtyThousandWords) {
  std::size_t words = 0;
  for (const fs::path& page : pages()) words += countWords(textOf(page));
  RecordProperty("words", static_cast<int>(words));
  EXPECT_GT(words, 10'000u);
  EXPECT_LE(words, 30'000u);
}

TEST(Prose, hasSentencesOfWhichNineInTenHaveAtMost25Words) {
  std::vector<std::size_t> lengths;
  for (const fs::path& page : pages())
    for (const std::string& sentence : sentencesOf(textOf(page)))
      lengths.push_back(countWords(sentence));
  EXPECT_LE(quantile(lengths, 0.9), 25u);
}

TEST(Prose, ofLongPagesIsNamed) {
  nameLongPages(kSources / "doc/how-it-works", 1200);
  nameLongPages(kSources / "doc/handbook", 800);
  nameLongPages(kSources / "apps", 400);
}

TEST(Prose, isCountedWithoutHeadingsAndCode) {
  EXPECT_EQ(
      sentencesOf(
          "# A heading of five words\n\nOne two [three four](five.md) `a b`\nsix. "
          "And a second *sentence* here!\n\n    code of four words\n\n"
          "```sh\nmore code of words\n```\n"
          "- an item of words\n- only three words\n\n| a cell of words | no |\n|---|---|\n"),
      (std::vector<std::string>{"One two three four Code six", "And a second *sentence* here! ",
                                "an item of words ", " a cell of words "}));
  EXPECT_EQ(countWords("one - two2 | (three) --"), 3u);
}

TEST(Prose, thatIsTooLongIsFound) {
  EXPECT_EQ(quantile({30, 1, 2, 3, 4, 5, 6, 7, 8, 9}, 0.9), 9u);
  EXPECT_EQ(quantile({30, 31, 2, 3, 4, 5, 6, 7, 8, 9}, 0.9), 30u);
}
