#include <gtest/gtest.h>
#include <map_pictures/PictureFiles.h>

#include <opencv2/imgcodecs.hpp>

#include "FullDisk.h"
#include "TemporaryFolder.h"

using map_pictures::PngFile;

namespace {

cv::Mat noise(int rows, int cols) {
  cv::Mat picture(rows, cols, CV_8UC3);
  cv::RNG random(7);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

}  // namespace

TEST(PngFile, isThePictureOfItsRows) {
  const TemporaryFolder folder;
  const cv::Mat picture = noise(70, 43);
  PngFile png(folder / "a.png", picture.size());
  for (const auto& [from, to] : {std::pair(0, 1), {1, 50}, {50, 70}})
    png.add(picture.rowRange(from, to));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
  png.close();
  const cv::Mat read = cv::imread((folder / "a.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.size(), picture.size());
  ASSERT_EQ(read.type(), CV_8UC3);
  EXPECT_EQ(cv::norm(read, picture, cv::NORM_INF), 0);
}

TEST(PngFile, takesOnlyItsOwnRows) {
  const TemporaryFolder folder;
  PngFile png(folder / "a.png", {10, 5});
  EXPECT_THROW(png.add(noise(1, 9)), std::invalid_argument);
  EXPECT_THROW(png.add(noise(6, 10)), std::invalid_argument);
  EXPECT_THROW(png.add(cv::Mat(1, 10, CV_8U, cv::Scalar(0))), std::invalid_argument);
  png.add(noise(3, 10));
  EXPECT_THROW(png.close(), std::invalid_argument);
  EXPECT_THROW(png.add(noise(3, 10)), std::invalid_argument);
  png.add(noise(2, 10));
  png.close();
}

TEST(PngFile, thatIsNotFinishedIsNotThere) {
  const TemporaryFolder folder;
  folder.write("a.png", "before");
  {
    PngFile png(folder / "a.png", {10, 5});
    png.add(noise(3, 10));
  }
  EXPECT_EQ(folder.read("a.png"), "before");
}

TEST(PngFile, thatCannotBeWrittenIsNamed) {
  const TemporaryFolder folder;
  const auto file = folder / "no" / "a.png";
  EXPECT_TRUE(contains(errorOf([&] { PngFile(file, {10, 5}); }), file.string()));
  const FullDisk disk(1000);
  const std::string full = errorOf([&] {
    PngFile png(folder / "full.png", {100, 90});
    png.add(noise(90, 100));
    png.close();
  });
  EXPECT_TRUE(contains(full, "full.png")) << full;
  EXPECT_FALSE(std::filesystem::exists(folder / "full.png"));
}
