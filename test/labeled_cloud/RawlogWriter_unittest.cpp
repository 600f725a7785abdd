#include <gtest/gtest.h>
#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>

#include "TemporaryFolder.h"

using namespace labeled_cloud;

TEST(RawlogWriter, theFileAppearsWhenItIsCompleteAndReplacesTheOldOne) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.rawlog", "old");
  {
    RawlogWriter writer(file);
    writer.write(CObservationLabeledCloud());
    EXPECT_EQ(folder.read("a.rawlog"), "old");
    writer.finish();
  }
  RawlogReader reader(file);
  EXPECT_TRUE(reader.next());
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(RawlogWriter, whatWasThereStaysIfItIsNotFinished) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.rawlog", "old");
  CObservationLabeledCloud bad;
  bad.cloud.classes = {1};
  EXPECT_ANY_THROW(RawlogWriter(file).write(bad));
  EXPECT_EQ(folder.read("a.rawlog"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}
