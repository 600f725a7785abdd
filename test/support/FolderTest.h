#pragma once
#include <gtest/gtest.h>

#include "TemporaryFolder.h"

/** A test with a folder of its own. */
class FolderTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder / name).string(); }

  TemporaryFolder folder;
};
