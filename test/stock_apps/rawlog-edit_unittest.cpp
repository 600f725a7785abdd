#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>

#include "StockApps.h"

using labeled_cloud::CObservationLabeledCloud;

namespace {

class RawlogEdit : public StockApps {
 protected:
  void SetUp() override { SKIP_WITHOUT_APP("rawlog-edit"); }
  CommandRun edit(const std::string& arguments) const { return run("rawlog-edit " + arguments); }
};

std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const std::filesystem::path& file) {
  std::vector<mrpt::obs::CObservation::Ptr> all;
  labeled_cloud::RawlogReader reader(file);
  while (const auto entry = reader.next())
    all.insert(all.end(), entry->observations.begin(), entry->observations.end());
  return all;
}

const char* const kVillage = "rawlog-samples/village.rawlog";

}  // namespace

TEST_F(RawlogEdit, listsRawlogsWithLabeledClouds) {
  const CommandRun listed = edit(std::string("-p ") + kPlugin + " --info -i " + kVillage);
  EXPECT_EQ(listed.status, 0);
  EXPECT_TRUE(contains(listed.output, "Overall number of objects         : 72"));
  EXPECT_TRUE(contains(listed.output, "LIDAR /     24")) << listed.output;
}

TEST_F(RawlogEdit, describesTheClouds) {
  const CommandRun cut = edit(std::string("-p ") + kPlugin + " --describe -i " + kVillage);
  EXPECT_TRUE(contains(cut.output, "labeled_cloud::CObservationLabeledCloud"));
  EXPECT_TRUE(contains(cut.output, "road: ")) << cut.output.substr(0, 3000);
}

TEST_F(RawlogEdit, cutsThemWithoutChangingABit) {
  if (!kRawlogEditDrops) GTEST_SKIP() << "rawlog-edit of this MRPT drops nothing";
  const CommandRun cut =
      edit(std::string("-p ") + kPlugin + " --cut --from-index 3 --to-index 8 -i " + kVillage +
           " -o cut.rawlog");
  ASSERT_EQ(cut.status, 0) << cut.output;
  const auto before = observationsOf(folder / kVillage),
             after = observationsOf(folder / "cut.rawlog");
  ASSERT_EQ(after.size(), 6u);
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_EQ(after[i]->GetRuntimeClass(), before[i + 3]->GetRuntimeClass());
    const auto a = std::dynamic_pointer_cast<CObservationLabeledCloud>(after[i]);
    const auto b = std::dynamic_pointer_cast<CObservationLabeledCloud>(before[i + 3]);
    if (!a) continue;
    EXPECT_EQ(a->cloud.points, b->cloud.points);
    EXPECT_EQ(a->cloud.classes, b->cloud.classes);
    EXPECT_EQ(a->classNames, b->classNames);
  }
}

TEST_F(RawlogEdit, picksThemByTheirSensorsLabel) {
  if (!kRawlogEditDrops) GTEST_SKIP() << "rawlog-edit of this MRPT drops nothing";
  const CommandRun kept = edit(std::string("-p ") + kPlugin + " --keep-label LIDAR -i " + kVillage +
                               " -o lidar.rawlog");
  ASSERT_EQ(kept.status, 0) << kept.output;
  const auto clouds = observationsOf(folder / "lidar.rawlog");
  EXPECT_EQ(clouds.size(), 24u);
  for (const auto& cloud : clouds)
    EXPECT_TRUE(std::dynamic_pointer_cast<CObservationLabeledCloud>(cloud));
}

TEST_F(RawlogEdit, withoutThePluginTheRawlogEndsAtTheFirstCloudAndTheStatusIsZero) {
  const CommandRun listed = edit(std::string("--info -i ") + kVillage);
  EXPECT_EQ(listed.status, 0);
  EXPECT_TRUE(contains(listed.output, "which is not registered"));
  EXPECT_TRUE(contains(listed.output, "Overall number of objects         : 2"));
}
