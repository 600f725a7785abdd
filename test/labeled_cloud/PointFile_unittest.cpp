#include <gtest/gtest.h>
#include <labeled_cloud/PointFile.h>

#include <cstring>
#include <random>
#include <sstream>

#include "TemporaryFolder.h"

using labeled_cloud::PointFile;
using labeled_cloud::readPointFile;

namespace {

struct Point {
  double x;
  float y, z;
  std::uint16_t label;
};

std::vector<Point> randomPoints(std::size_t count) {
  std::mt19937 random(5);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({std::ldexp(random(), -20) - 2000, std::ldexp(float(random() % 999), -4),
                      -std::ldexp(float(random() % 999), -6),
                      static_cast<std::uint16_t>(random() % 300)});
  return points;
}

template <typename T>
std::string bytesOf(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/** Writes points in one format; between the fields lie some that nobody asks for. */
std::string text(const std::vector<Point>& points) {
  std::ostringstream out;
  out.precision(17);
  for (const Point& p : points)
    out << p.y << " 1 2 3 " << p.label << ' ' << p.x << ' ' << p.z << '\n';
  return out.str();
}

std::string rows(const std::vector<Point>& points) {
  std::string out;
  for (const Point& p : points)
    out += bytesOf(p.y) + "abc" + bytesOf(p.label) + bytesOf(p.x) + bytesOf(p.z);
  return out;
}

std::string pcdHead(std::size_t points, const std::string& format) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS y _ class x z\nSIZE 4 1 2 8 4\nTYPE F U U F F\n"
         "COUNT 1 3 1 1 1\nPOINTS " +
         std::to_string(points) + "\nDATA " + format + "\n";
}

PointFile read(const std::string& bytes, const std::string& label = "class") {
  const TemporaryFolder folder;
  return readPointFile(folder.write("points", bytes), label);
}

void expectPoints(const PointFile& file, const std::vector<Point>& points) {
  ASSERT_EQ(file.points.size(), points.size());
  ASSERT_EQ(file.labels.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(file.points[i], Eigen::Vector3d(points[i].x, points[i].y, points[i].z)) << i;
    EXPECT_EQ(file.labels[i], points[i].label) << i;
  }
}

std::string failureOf(const std::string& bytes, const std::string& label = "class") {
  return errorOf([&] { read(bytes, label); });
}

#define EXPECT_FAILURE(bytes, said) \
  EXPECT_TRUE(contains(failureOf(bytes), said)) << failureOf(bytes)

}  // namespace

TEST(PointFile, anyFormatGivesTheSamePoints) {
  const auto points = randomPoints(500);
  for (const std::string& bytes :
       {pcdHead(500, "ascii") + text(points), pcdHead(500, "binary") + rows(points)})
    expectPoints(read(bytes), points);
  EXPECT_TRUE(read(pcdHead(500, "binary") + rows(points), "").labels.empty())
      << "none are asked for";
}

TEST(PointFile, announcedSizesAreHeldAgainstTheBytes) {
  const std::string three = rows(randomPoints(3));
  EXPECT_FAILURE(pcdHead(4, "binary") + three, "63 bytes of data for 4 points of 21 bytes");
  EXPECT_FAILURE(pcdHead(1000000000000, "binary") + three, "for 1000000000000 points");
  EXPECT_FAILURE(pcdHead(1000000000000, "ascii") + "1 2\n", "1 lines of data for 1000000000000");
}

TEST(PointFile, coordinatesMayBeMissing) {
  const auto points = read("FIELDS x y z class\nPOINTS 1\nDATA ascii\nnan -nan 1 2\n").points;
  EXPECT_TRUE(points.at(0).head<2>().array().isNaN().all());
}

TEST(PointFile, whatIsMalformedIsNamed) {
  const std::string three = rows(randomPoints(3));
  const std::string good = pcdHead(3, "binary") + three;
  EXPECT_TRUE(contains(failureOf(good, "label"), "no field 'label' among 'y' '_' 'class' 'x' 'z'"));
  EXPECT_TRUE(contains(failureOf(good, "_"), "points:3: field '_' has several values"));
  EXPECT_FAILURE(pcdHead(3, "binary_compressed") + three,
                 "points:8: data 'binary_compressed', expected ascii or binary");
  const std::string plain = "FIELDS x y z class\nPOINTS 1\nDATA binary\n";
  EXPECT_FAILURE(plain, "binary data, and no SIZE");
  EXPECT_FAILURE("SIZE 4 4 4\nTYPE F F F F\n" + plain, "3 sizes for 4 fields");
  EXPECT_FAILURE("SIZE 4 4 4 3\nTYPE F F F U\n" + plain + std::string(15, 'a'),
                 "field 'class' has type U and size 3");
  const std::string rest = "TYPE F F F F\nSIZE 4 4 4 4\n" + plain;
  EXPECT_FAILURE(rest + std::string(12, 'a') + bytesOf(1.5f), "point 0: label 1.5 is no class id");
  const std::string text = "FIELDS x y z class\nPOINTS 2\nDATA ascii\n1 2 3 4\n";
  EXPECT_FAILURE(text + "5 6\n", "points:5: '5 6': too few values");
  for (const char* word : {"x", "2abc", "-1"})
    EXPECT_FAILURE(text + "5 6 7 " + word + "\n", std::string("points:5: '5 6 7 ") + word);
  for (const std::string points : {"-1", "0.5", "1e300"})
    EXPECT_FAILURE("FIELDS x y z\nPOINTS " + points + "\nDATA ascii\n",
                   "points:2: " + points + ", expected a whole number");
  EXPECT_FAILURE("FIELDS x\nPOINTS 0x4\nDATA ascii\n", "points:2: expected a number, found '0x4'");
  EXPECT_FAILURE("COUNT 1 1 1\n" + text, "points:1: 3 counts for 4 fields");
  for (const char* grid : {"WIDTH 3\nHEIGHT 1", "WIDTH 2\nHEIGHT 0", "WIDTH 0\nHEIGHT 0",
                           "WIDTH 1\nHEIGHT 1099511627776"})
    EXPECT_FAILURE(std::string(grid) + "\n" + text + "5 6 7 8\n", " points, and POINTS says 2");
  EXPECT_FAILURE("nothing\n", "no FIELDS");
}
