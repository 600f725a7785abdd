// What rawlog2semantic-map says of bad input, and that it leaves what was there.

#include <array>
#include <opencv2/imgcodecs.hpp>

#include "CompressedInput.h"
#include "MappingFixture.h"

namespace fs = std::filesystem;

namespace {

std::string uncompressed(const fs::path& file) {
  CompressedInput in(file.string());
  std::string bytes;
  for (char c; in.Read(&c, 1) == 1;) bytes += c;
  return bytes;
}

}  // namespace

TEST_F(Rawlog2SemanticMap, aMissingRawlogIsRefused) {
  expectRefusal({"none.rawlog"}, "none.rawlog");
}

TEST_F(Rawlog2SemanticMap, anEmptyRawlogIsRefused) {
  folder.write("empty.rawlog", "");
  expectRefusal({"empty.rawlog", "empty"}, "empty.rawlog");
}

TEST_F(Rawlog2SemanticMap, aTruncatedRawlogIsRefused) {
  const std::string whole = folder.read("small.rawlog");
  for (const std::size_t bytes : {whole.size() / 2, whole.size() - 1}) {
    folder.write("cut.rawlog", whole.substr(0, bytes));
    expectRefusal({"cut.rawlog", "cut off"}, "cut.rawlog");
  }
}

TEST_F(Rawlog2SemanticMap, aCorruptRawlogIsRefused) {
  std::string bytes = folder.read("small.rawlog");
  bytes[bytes.size() / 2] ^= 0x55;
  folder.write("corrupt.rawlog", bytes);
  expectRefusal({"corrupt.rawlog"}, "corrupt.rawlog");
  folder.write("text.rawlog", "This is no rawlog.");
  expectRefusal({"text.rawlog: ", "object 1"}, "text.rawlog");
}

TEST_F(Rawlog2SemanticMap, aDepthImageThatClaimsToBeHugeIsRefusedBeforeItTakesMemory) {
  constexpr std::uint32_t kRows = 29, kCols = 31, kClaimed = 40000;  // 3.2 GB
  std::string bytes =
      uncompressed(writeSmallRawlog(folder / "depth.rawlog", depthImage(10, kRows, kCols)));
  const auto inBytes = [](std::uint32_t rows, std::uint32_t cols) {
    return std::string(reinterpret_cast<char*>(&rows), 4) +
           std::string(reinterpret_cast<char*>(&cols), 4);
  };
  const std::size_t size = bytes.find(inBytes(kRows, kCols));
  ASSERT_NE(size, std::string::npos);
  folder.write("huge.rawlog", bytes.replace(size, 8, inBytes(kClaimed, kClaimed)));
  expectRefusal({"huge.rawlog", "more than 1 GiB of memory is asked for at once"}, "huge.rawlog");
  EXPECT_LT(run("huge.rawlog").peakKilobytes, 500'000);
}

TEST_F(Rawlog2SemanticMap, aScanThatClaimsToHaveAHugeCalibrationIsRefusedBeforeItTakesMemory) {
  fs::copy_file(
      fs::path(MSO_SOURCE_DIR) / "test/fuzz/corpus/rawlog/velodyne_calibration_beyond_memory",
      folder / "calibration.rawlog");
  expectRefusal({"calibration.rawlog", "object 2"}, "calibration.rawlog");
  EXPECT_LT(run("calibration.rawlog").peakKilobytes, 500'000);
}

TEST_F(Rawlog2SemanticMap, aRawlogThatBreaksOffWhileItIsMappedLeavesNothing) {
  const std::string whole = folder.read("small.rawlog");
  folder.write("cut.rawlog", whole.substr(0, whole.size() - 1));
  folder.write("poses.tum", "9 3.1 0 0 0 0 0 1\n11 5.1 0 0 0 0 0 1\n");
  const std::vector<std::string> poses = {"--trajectory", (folder / "poses.tum").string()};
  expectRefusal({"cut.rawlog", "cut off"}, "cut.rawlog", poses);
  fs::remove_all(folder / "out");
  EXPECT_EQ(run("cut.rawlog", poses).status, 1);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Rawlog2SemanticMap, aRawlogWithoutPosesIsRefused) {
  writeSmallRawlog(folder / "lost.rawlog", smallScan(10));
  expectRefusal({"lost.rawlog", "no robot poses"}, "lost.rawlog");
}

TEST_F(Rawlog2SemanticMap, aRawlogOfWhichNothingCanBeInsertedIsRefused) {
  writeSmallRawlog(folder / "late.rawlog", robotPose(10, 0), smallScan(20));
  expectRefusal({"nothing to map", "1 outside the trajectory"}, "late.rawlog");
}

TEST_F(Rawlog2SemanticMap, aRelevantClassThatTheTableLacksIsRefused) {
  folder.write("small.ini", kSmallConfig + std::string("[abstraction]\nrelevant = rode: 1\n"));
  expectRefusal({"small.ini: [abstraction] with the classes of ", "classes.yaml: relevant: ",
                 "unknown class 'rode'", "known are free_space, road", "did you mean 'road'?"});
}

TEST_F(Rawlog2SemanticMap, aClassThatTheTableLacksIsRefused) {
  folder.write("classes.yaml", "classes:\n  - {id: 1, name: road, color: [1, 2, 3]}\n");
  expectRefusal({"small.rawlog: observation 2", "lidar", "car"});
}

TEST_F(Rawlog2SemanticMap, aLabelImageOfTheWrongSizeIsRefused) {
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40));
  fs::create_directory(folder / "labels");
  cv::imwrite((folder / "labels/10.00.png").string(), cv::Mat(40, 30, CV_8UC1, cv::Scalar(2)));
  expectRefusal({"depth.rawlog: observation 2", "10.00.png", "30", "40"}, "depth.rawlog",
                {"--labels", (folder / "labels").string()});
}

TEST_F(Rawlog2SemanticMap, anUnknownClassInALabelImageIsRefused) {
  writeSmallRawlog(folder / "depth.rawlog", robotPose(10, 0), depthImage(10, 40, 40));
  fs::create_directory(folder / "labels");
  cv::imwrite((folder / "labels/10.00.png").string(), cv::Mat(40, 40, CV_8UC1, cv::Scalar(77)));
  expectRefusal({"10.00.png", "77"}, "depth.rawlog", {"--labels", (folder / "labels").string()});
}

TEST_F(Rawlog2SemanticMap, aFolderWithoutLabelImagesIsRefused) {
  expectRefusal({"no-labels"}, "small.rawlog", {"--labels", (folder / "no-labels").string()});
}

TEST_F(Rawlog2SemanticMap, anUnknownKeyIsRefusedWithFileSectionAndKey) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"map", "resolutoin"}, {"insertion", "maxrnage"}, {"labels", "folder"}, {"pictures", "size"}};
  for (const auto& [section, key] : wrong) {
    folder.write("small.ini", "[" + section + "]\n" + key + " = 1\n");
    expectRefusal({"small.ini", "[" + section + "]", "'" + key + "'"});
  }
}

TEST_F(Rawlog2SemanticMap, anUnknownSectionIsRefused) {
  folder.write("small.ini", std::string(kSmallConfig) + "[inserting]\nmax_range = 3\n");
  expectRefusal({"small.ini", "[inserting]", "did you mean 'insertion'?"});
}

TEST_F(Rawlog2SemanticMap, valuesOutOfRangeAreRefused) {
  const std::vector<std::array<std::string, 3>> wrong = {
      {"map", "resolution", "-0.1"},    {"map", "resolution", "fine"},
      {"insertion", "accuracy", "1.5"}, {"insertion", "max_range", "-1"},
      {"labels", "tolerance", "x"},     {"labels", "match", "guess"},
      {"pictures", "width", "12.5"},    {"pictures", "tilt", "nan"}};
  for (const auto& [section, key, value] : wrong) {
    folder.write("small.ini", "[" + section + "]\n" + key + " = " + value + "\n");
    expectRefusal({key});
  }
}

TEST_F(Rawlog2SemanticMap, valuesOutOfRangeOnTheCommandLineAreRefused) {
  for (const auto& [option, value, expected] : std::vector<std::array<std::string, 3>>{
           {"--resolution", "0", "--resolution is 0, expected a number above 0"},
           {"--max-range", "-3", "--max-range is -3, expected a number of 0 or more"}}) {
    const ProgramRun result = run("small.rawlog", {option, value});
    EXPECT_EQ(result.status, 64);
    EXPECT_TRUE(contains(result.errors, expected)) << result.errors;
  }
}

TEST_F(Rawlog2SemanticMap, missingFilesAreRefusedByName) {
  expectRefusal({"none.yaml"}, "small.rawlog", {"--classes", (folder / "none.yaml").string()});
  expectRefusal({"none.tum"}, "small.rawlog", {"--trajectory", (folder / "none.tum").string()});
  fs::remove(folder / "small.ini");
  expectRefusal({"small.ini"});
}

TEST_F(Rawlog2SemanticMap, anOutputFolderThatCannotBeWrittenIsRefusedByName) {
  const fs::path file = folder.write("file", "of before");
  for (const fs::path& output : {file, file / "below"}) {
    const ProgramRun result =
        runProgram("rawlog2semantic-map", {"--config", (folder / "small.ini").string(), "--output",
                                           output.string(), (folder / "small.rawlog").string()});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(contains(result.errors, output.string() + ": cannot write")) << result.errors;
    EXPECT_EQ(folder.read("file"), "of before");
  }
}

TEST_F(Rawlog2SemanticMap, aScanFromOutsideTheMapIsRefused) {
  writeSmallRawlog(folder / "far.rawlog", robotPose(10, 1e6), smallScan(10));
  expectRefusal({"far.rawlog: observation 2", "outside the map"}, "far.rawlog");
}
