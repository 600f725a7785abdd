#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "OptionTables.h"

TEST(OptionsPage, isWhatTheListsSay) {
  const std::string file = MSO_SOURCE_DIR "/doc/handbook/options.md", page = optionsPage();
  if (std::getenv("MSO_WRITE_PAGES")) std::ofstream(file) << page;
  std::ifstream in(file);
  std::ostringstream found;
  found << in.rdbuf();
  EXPECT_TRUE(found.str() == page)
      << "doc/handbook/options.md is not what the options say. Write it anew:\n"
         "  MSO_WRITE_PAGES=1 ctest --test-dir build -R OptionsPage";
}

TEST(OptionsPage, everyOptionHasANameOfItsOwnAndIsExplained) {
  for (const OptionTable& table : optionTables()) {
    std::set<std::string> names;
    for (const auto& option : table.list.options()) {
      EXPECT_TRUE(names.insert(option.name).second) << table.title << ": " << option.name;
      EXPECT_EQ(option.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
                std::string::npos)
          << option.name;
      EXPECT_FALSE(option.help.empty()) << option.name;
      EXPECT_EQ(option.help.find('|'), std::string::npos) << option.name;
    }
  }
}

TEST(OptionsPage, everyDefaultIsTextThatIsReadBack) {
  for (const OptionTable& table : optionTables())
    for (const auto& option : table.list.options()) {
      const std::string before = option.text();
      const bool mustBeGiven = option.help.find("must be given") != std::string::npos;
      if (!mustBeGiven) option.set(before);
      EXPECT_EQ(option.text(), before) << table.title << ": " << option.name;
    }
}
