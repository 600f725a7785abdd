#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <strict_files/Csv.h>

#include <cstdlib>

using strict_files::csvField;

namespace {

/** RapidCheck draws the same cases in every run, unless told otherwise. */
const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240517", 0);

/** The fields of one record, as RFC 4180 has them. */
std::vector<std::string> fieldsOf(const std::string& record) {
  std::vector<std::string> fields(1);
  bool inQuotes = false;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const char c = record[i];
    if (c == '"' && inQuotes && i + 1 < record.size() && record[i + 1] == '"')
      fields.back() += record[++i];
    else if (c == '"')
      inQuotes = !inQuotes;
    else if (c == ',' && !inQuotes)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

}  // namespace

TEST(CsvField, leavesPlainTextAsItIs) {
  EXPECT_EQ(csvField("road"), "road");
  EXPECT_EQ(csvField(""), "");
  EXPECT_EQ(csvField("a; b"), "a; b");
}

TEST(CsvField, quotesCommasQuotesAndLineEnds) {
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("the \"road\""), "\"the \"\"road\"\"\"");
  EXPECT_EQ(csvField("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csvField("a\rb"), "\"a\rb\"");
}

TEST(CsvField, leavesUtf8AsItIs) {
  EXPECT_EQ(csvField("Straße"), "Straße");
  EXPECT_EQ(csvField("Straße, 路"), "\"Straße, 路\"");
}

TEST(CsvField, anyTextsComeBackFromTheirRecord) {
  EXPECT_TRUE(rc::check([] {
    const auto text = rc::gen::container<std::string>(rc::gen::element(',', '"', '\n', '\r', 'a'));
    const auto a = *text, b = *text;
    RC_ASSERT(fieldsOf(csvField(a) + "," + csvField(b)) == (std::vector<std::string>{a, b}));
  }));
}
