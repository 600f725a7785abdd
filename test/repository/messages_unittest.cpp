// What the programs say, and what the handbook says of it.
#include <gtest/gtest.h>

#include "MessageRules.h"
#include "TemporaryFolder.h"

namespace {

using Findings = std::vector<std::string>;

const std::filesystem::path kRoot = MSO_SOURCE_DIR;

}  // namespace

TEST(Messages, thatTheHandbookExplainsAreThoseOfTheSources) {
  EXPECT_EQ(messagesNobodySays(kRoot / "doc/handbook/troubleshooting.md",
                               {kRoot / "libs", kRoot / "apps"}),
            Findings());
}

TEST(Messages, thatNobodySaysAreFound) {
  const TemporaryFolder folder;
  folder.write(
      "main.cpp",
      "fail(file + \": has \" + count + \" bytes too \"\n     \"many\"); fail(\"unknown \" + "
      "kind);\nkind = \"section\";\n");
  folder.write("file.md",
               "| message | what |\n|---|---|\n| `FILE: has 3 bytes too many` | `other` |\n"
               "| `unknown section` | |\n| `FILE: has no bytes`, `unknown key X` | |\n");
  EXPECT_EQ(messagesNobodySays(folder / "file.md", {folder.path()}),
            (Findings{"file.md:5: has no bytes", "file.md:5: unknown key"}));
}
