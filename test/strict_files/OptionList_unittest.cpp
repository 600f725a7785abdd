#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "SomeOptions.h"
#include "TemporaryFolder.h"

using some::Color;
using some::Options;
using strict_files::Option;
using strict_files::OptionList;

namespace {

OptionList listOf(Options& options) {
  OptionList list;
  options.describe(list);
  return list;
}

/** What setting an option to this text fails with; empty: it does not. */
std::string refusal(const std::string& name, const std::string& text) {
  Options options;
  const OptionList list = listOf(options);
  return errorOf([&] { list.find(name)->set(text); });
}

}  // namespace

TEST(OptionList, anOptionIsFoundHoweverItsWordsAreParted) {
  Options options;
  const OptionList list = listOf(options);
  for (const char* name : {"max_gap", "maxGap", "max-gap", "MAXGAP"}) {
    ASSERT_TRUE(list.find(name)) << name;
    EXPECT_EQ(list.find(name)->name, "max_gap");
  }
  EXPECT_FALSE(list.find("maximal_gap"));
}

TEST(OptionList, textsAreOfEachKind) {
  Options options;
  const OptionList list = listOf(options);
  std::vector<std::string> texts;
  for (const Option& option : list.options()) texts.push_back(option.text());
  EXPECT_EQ(texts, (std::vector<std::string>{"2", "inf", "3", "7", "true", "false", "green",
                                             "a title", "none", "1, 2, 3"}));
}

TEST(OptionList, whatIsAllowedIsSaidInWords) {
  Options options;
  const OptionList list = listOf(options);
  const auto expected = [&](const char* name) { return list.find(name)->expected; };
  EXPECT_EQ(expected("length"), "a number above 0 up to 10");
  EXPECT_EQ(expected("max_gap"), "a number of 0 or more, or infinite");
  EXPECT_EQ(expected("count"), "a whole number of 1 or more");
  EXPECT_EQ(expected("small"), "a whole number from 0 to 255");
  EXPECT_EQ(expected("on"), "true or false");
  EXPECT_EQ(expected("color"), "one of dark_red, green");
  EXPECT_EQ(expected("floor"), "a number below 5, or none");
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
  const OptionList list = listOf(options);
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
  const OptionList untouched = listOf(fresh);
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
  OptionList list = listOf(options);
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
  const OptionList from = listOf(options), to = listOf(read);
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
