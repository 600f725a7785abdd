#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <strict_files/TextFile.h>

#include <cstdlib>

#include "CsvTable.h"

using strict_files::csvField;

namespace {

/** RapidCheck draws the same cases in every run, unless told otherwise. */
const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

}  // namespace

TEST(CsvField, quotesCommasQuotesAndLineEnds) {
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("the \"road\""), "\"the \"\"road\"\"\"");
  EXPECT_EQ(csvField("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csvField("a\rb"), "\"a\rb\"");
}

TEST(CsvField, anyTextsComeBackFromTheirRecord) {
  EXPECT_TRUE(rc::check([] {
    const auto text = rc::gen::container<std::string>(rc::gen::element(',', '"', '\n', '\r', 'a'));
    const auto a = *text, b = *text;
    const auto table = csvTable("x,y\n" + csvField(a) + "," + csvField(b) + "\n");
    RC_ASSERT(table.at(1) == (std::vector<std::string>{a, b}));
  }));
}
