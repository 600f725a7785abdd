#include <gtest/gtest.h>
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/ScanConverter.h>
#include <mrpt/obs/CObservationImage.h>
#include <png.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "Classes.h"
#include "DepthCamera.h"
#include "TemporaryFolder.h"

using namespace labeled_cloud;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

ClassTable roadGrassSky() {
  ClassTable table = tableOf({{"road", {255, 0, 0}}, {"grass", {0, 255, 1}}, {"sky", {0, 0, 255}}});
  table.fold(0, 0);
  for (const int id : {1, 2, 3}) table.fold(id, static_cast<semantic_types::ClassId>(id));
  table.fold(40000, 3);
  return table;
}

std::filesystem::path save(const TemporaryFolder& folder, const std::string& name,
                           const cv::Mat& m) {
  cv::imwrite((folder / name).string(), m);
  return folder / name;
}

/** A PNG with a palette: indices and one RGB entry for each. */
std::filesystem::path savePalette(const TemporaryFolder& folder, const std::string& name, int cols,
                                  std::vector<std::uint8_t> indices,
                                  const std::vector<std::uint8_t>& rgb) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = cols;
  png.height = static_cast<png_uint_32>(indices.size()) / cols;
  png.format = PNG_FORMAT_RGB_COLORMAP;
  png.colormap_entries = static_cast<png_uint_32>(rgb.size()) / 3;
  png_image_write_to_file(&png, (folder / name).c_str(), 0, indices.data(), 0, rgb.data());
  return folder / name;
}

std::string errorReading(const std::filesystem::path& file) {
  const std::string error = errorOf([&] { readLabelImage(file, roadGrassSky()); });
  EXPECT_EQ(error.rfind(file.string() + ": ", 0), 0u) << "does not name the file: " << error;
  return error;
}

mrpt::obs::CObservation3DRangeScan::Ptr scanAt(double time) {
  auto scan = DepthCamera().see([](int, int) { return 1; });
  scan->timestamp = mrpt::Clock::fromDouble(time);
  return scan;
}

cv::Mat filledWith(int id) { return cv::Mat(40, 60, CV_8UC1, cv::Scalar(id)); }

}  // namespace

TEST(LabelImages, ofEightAndSixteenBitsHoldRawIds) {
  const TemporaryFolder folder;
  const auto narrow = readLabelImage(
      save(folder, "8.png", (cv::Mat_<std::uint8_t>(2, 3) << 0, 1, 2, 3, 2, 1)), roadGrassSky());
  EXPECT_EQ(narrow.rows, 2);
  EXPECT_EQ(narrow.cols, 3);
  EXPECT_EQ(narrow.classes, (std::vector<ClassId>{0, 1, 2, 3, 2, 1}));
  const auto wide = readLabelImage(
      save(folder, "16.png", (cv::Mat_<std::uint16_t>(1, 3) << 40000, 1, 0)), roadGrassSky());
  EXPECT_EQ(wide.classes, (std::vector<ClassId>{3, 1, 0}));
  EXPECT_EQ(wide.origin, (folder / "16.png").string());
}

TEST(LabelImages, ofOneBitHoldRawIdsToo) {
  const TemporaryFolder folder;
  cv::Mat bits(9, 11, CV_8UC1, cv::Scalar(0));
  bits.at<std::uint8_t>(3, 7) = 255;
  cv::imwrite((folder / "bit.png").string(), bits, {cv::IMWRITE_PNG_BILEVEL, 1});
  std::vector<ClassId> expected(99, 0);
  expected[3 * 11 + 7] = 1;
  EXPECT_EQ(readLabelImage(folder / "bit.png", roadGrassSky()).classes, expected);
}

TEST(LabelImages, arePngWhateverTheirNameIs) {
  const TemporaryFolder folder;
  const cv::Mat ids = (cv::Mat_<std::uint8_t>(2, 3) << 0, 1, 2, 3, 2, 1);
  for (const char* name : {"a.tif", "a.bmp", "a.pgm", "a.jpg"})
    EXPECT_TRUE(contains(errorReading(save(folder, name, ids)), "it is no PNG image")) << name;
  EXPECT_EQ(
      readLabelImage(folder.write("b.jpg", folder.read(save(folder, "a.png", ids).filename())),
                     roadGrassSky())
          .classes,
      (std::vector<ClassId>{0, 1, 2, 3, 2, 1}));
}

TEST(LabelImages, thatUnpackToMuchMoreThanTheirFileAreRefused) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "bomb.png").string(), cv::Mat(8192, 16600, CV_8UC1, cv::Scalar(0)),
              {cv::IMWRITE_PNG_BILEVEL, 1, cv::IMWRITE_PNG_COMPRESSION, 9});
  EXPECT_TRUE(contains(errorReading(folder / "bomb.png"), "16600 x 8192 pixels, more than a file"));
  cv::imwrite((folder / "8k.png").string(), cv::Mat(4320, 7680, CV_8UC3, cv::Scalar(0, 0, 255)),
              {cv::IMWRITE_PNG_COMPRESSION, 9});
  EXPECT_EQ(readLabelImage(folder / "8k.png", roadGrassSky()).cols, 7680);
}

TEST(LabelImages, inColorHoldColorsOfTheTableAndBlackForNone) {
  const TemporaryFolder folder;
  const cv::Mat bgr = (cv::Mat_<cv::Vec3b>(1, 4) << cv::Vec3b(0, 0, 255), cv::Vec3b(1, 255, 0),
                       cv::Vec3b(255, 0, 0), cv::Vec3b(0, 0, 0));
  const std::vector<ClassId> expected{1, 2, 3, 0};
  EXPECT_EQ(readLabelImage(save(folder, "c.png", bgr), roadGrassSky()).classes, expected);
  cv::Mat bgra(1, 4, CV_8UC4);
  for (int i = 0; i < 4; ++i) {
    const auto p = bgr.at<cv::Vec3b>(0, i);
    bgra.at<cv::Vec4b>(0, i) = {p[0], p[1], p[2], 128};
  }
  EXPECT_EQ(readLabelImage(save(folder, "a.png", bgra), roadGrassSky()).classes, expected);
}

TEST(LabelImages, withAPaletteHoldItsIndicesWhateverItsColors) {
  const TemporaryFolder folder;
  // two entries share a color: only the indices tell them apart
  const auto file =
      savePalette(folder, "p.png", 3, {0, 1, 2, 3, 1, 0}, {0, 0, 0, 9, 9, 9, 9, 9, 9, 255, 0, 0});
  EXPECT_EQ(readLabelImage(file, roadGrassSky()).classes, (std::vector<ClassId>{0, 1, 2, 3, 1, 0}));
}

TEST(LabelImages, anIdOrColorThatTheTableDoesNotKnowIsNamedWithItsPixel) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      contains(errorReading(save(folder, "8.png", (cv::Mat_<std::uint8_t>(2, 2) << 1, 1, 1, 77))),
               "raw class id 77 is not in the class table (pixel in row 1, column 1)"));
  EXPECT_TRUE(contains(
      errorReading(save(folder, "c.png", (cv::Mat_<cv::Vec3b>(1, 1) << cv::Vec3b(3, 2, 1)))),
      "color (1, 2, 3) is not in the class table"));
  ClassTable lenient = roadGrassSky();
  lenient.setUnknownRawId(ClassTable::UnknownRawId::NoClass);
  EXPECT_EQ(readLabelImage(folder / "8.png", lenient).classes, (std::vector<ClassId>{1, 1, 1, 0}));
  EXPECT_EQ(readLabelImage(folder / "c.png", lenient).classes, (std::vector<ClassId>{0}));
}

TEST(LabelImages, thatCannotBeUsedAreNamed) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(errorReading(folder.write("text.png", "no image")), "cannot be read"));
  EXPECT_TRUE(contains(errorReading(folder / "missing.png"), "no such file"));
  EXPECT_TRUE(contains(errorReading(save(folder, "16.png", cv::Mat(1, 1, CV_16UC3, cv::Scalar(1)))),
                       "expected ids"));
  savePalette(folder, "p.png", 2, {1, 1}, {0, 0, 0, 9, 9, 9});
  const std::string whole = folder.read("p.png");
  errorReading(folder.write("cut.png", whole.substr(0, whole.size() - 20)));
  cv::Mat ids(200, 200, CV_8UC1);
  cv::randu(ids, 1, 4);
  save(folder, "gray.png", ids);
  errorReading(folder.write("half.png", folder.read("gray.png").substr(0, 3000)));
}

TEST(ImageFiles, mayNotAnnounceMuchMoreThanTheirFile) {
  const TemporaryFolder folder;
  for (const char* name : {"a.jpg", "a.png"}) {
    SCOPED_TRACE(name);
    const cv::Mat read = readImageFile(
        save(folder, name, cv::Mat(200, 300, CV_8UC3, cv::Scalar(7, 7, 7))), ImageKinds::All);
    EXPECT_EQ(read.size(), cv::Size(300, 200));
  }
  // A segment, a byte that belongs to none, and the header of a frame.
  const std::string jpeg{"\xff\xd8\xff\xe0\0\4ab\1\xff\xff\xc2\0\x0b\x08\xc3\x50\xea\x60\1\1\x11\0",
                         22};
  EXPECT_TRUE(
      contains(errorOf([&] { readImageFile(folder.write("image", jpeg), ImageKinds::All); }),
               "image: says that it has 60000 x 50000 pixels, more than a file"));
}

TEST(LabelFolder, findsTheNearestInTime) {
  const TemporaryFolder folder;
  save(folder, "10.00.png", filledWith(1));
  save(folder, "10.10.png", filledWith(2));
  save(folder, "1700000000.123456.png", filledWith(3));
  folder.write("README.txt", "not a label image");
  LabelFolderOptions options;
  options.tolerance = 0.06;
  LabelFolder labels(folder.path(), roadGrassSky(), options);
  EXPECT_EQ(labels.label(*scanAt(10.04))->classes[0], 1);
  EXPECT_EQ(labels.label(*scanAt(10.051))->classes[0], 2);
  EXPECT_EQ(labels.label(*scanAt(9.95))->classes[0], 1);
  EXPECT_EQ(labels.label(*scanAt(1700000000.123456))->classes[0], 3);
  EXPECT_FALSE(labels.label(*scanAt(9.93)));
  EXPECT_FALSE(labels.label(*scanAt(10.2)));
}

TEST(LabelFolder, findsTheOneNamedLikeTheExternalImage) {
  const TemporaryFolder folder;
  save(folder, "frame_7.png", filledWith(2));
  LabelFolderOptions options;
  options.match = LabelFolderOptions::Match::Name;
  LabelFolder labels(folder.path(), roadGrassSky(), options);
  auto scan = scanAt(1);
  EXPECT_TRUE(contains(errorOf([&] { labels.label(*scan); }), "'cam' has no external image"));
  scan->hasIntensityImage = true;
  scan->intensityImage.setExternalStorage("frame_7.jpg");
  EXPECT_EQ(labels.label(*scan)->classes[0], 2);
  scan->intensityImage.setExternalStorage("frame_8.jpg");
  EXPECT_FALSE(labels.label(*scan));
}

TEST(LabelFolder, servesCamerasWithoutDepthToo) {
  const TemporaryFolder folder;
  save(folder, "10.png", filledWith(2));
  mrpt::obs::CObservationImage picture;
  picture.timestamp = mrpt::Clock::fromDouble(10);
  EXPECT_EQ(LabelFolder(folder.path(), roadGrassSky()).label(picture)->classes[0], 2);
  LabelFolderOptions options;
  options.match = LabelFolderOptions::Match::Name;
  picture.image.setExternalStorage("10.jpg");
  EXPECT_EQ(LabelFolder(folder.path(), roadGrassSky(), options).label(picture)->classes[0], 2);
}

TEST(LabelFolder, goesBeforeTheObservationsOwnLabelsAndIsAskedForEachScan) {
  const TemporaryFolder folder;
  save(folder, "10.png", filledWith(2));
  ScanConverter converter(roadGrassSky(), {},
                          std::make_shared<LabelFolder>(folder.path(), roadGrassSky()));
  auto scan = scanAt(10);
  DepthCamera().label(*scan, [](int, int) { return 1; });
  EXPECT_EQ(converter.convert(*scan)->cloud.classes[0], 2);
  scan->timestamp = mrpt::Clock::fromDouble(11);
  EXPECT_TRUE(converter.convert(*scan)->labelsMissing);
}

TEST(LabelFolder, aLabelImageOfAnotherSizeIsNamed) {
  const TemporaryFolder folder;
  save(folder, "10.png", cv::Mat(20, 60, CV_8UC1, cv::Scalar(1)));
  ScanConverter converter(roadGrassSky(), {},
                          std::make_shared<LabelFolder>(folder.path(), roadGrassSky()));
  const std::string error = errorOf([&] { converter.convert(*scanAt(10)); });
  EXPECT_TRUE(
      contains(error, "10.png: the label image has 60 x 20 pixels, the depth image 60 x 40"));
}

TEST(LabelFolder, badFoldersAndNamesAreNamed) {
  const auto error = [](const std::filesystem::path& path) {
    return errorOf([&] { LabelFolder(path, roadGrassSky()); });
  };
  EXPECT_TRUE(contains(error("/nowhere/labels"), "/nowhere/labels: there is no such folder"));
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(error(folder.path()), "no label image in this folder"));
  save(folder, "1.5.png", filledWith(1));
  save(folder, "1.50.png", filledWith(1));
  EXPECT_TRUE(contains(error(folder.path()), "a second label image of this time"));
  save(folder, "frame.png", filledWith(1));
  std::filesystem::remove(folder / "1.50.png");
  EXPECT_TRUE(contains(error(folder.path()), "frame.png: the label image's name is not a time"));
  std::filesystem::rename(folder / "frame.png", folder / "1700000000123456789.png");
  EXPECT_TRUE(contains(error(folder.path()), "it looks like nanoseconds"));
  LabelFolderOptions options;
  options.tolerance = -1;
  EXPECT_TRUE(
      contains(errorOf([&] { LabelFolder(folder.path(), {}, options); }), "tolerance is -1"));
}
