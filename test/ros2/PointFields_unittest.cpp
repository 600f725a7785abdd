#include "point_fields/PointFields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "TemporaryFolder.h"

using point_fields::cloudOf;
using point_fields::RawCloud;
using semantic_types::ClassTable;

namespace {

ClassTable table() {
  ClassTable t;
  t.add("road", {1, 2, 3});
  t.add("wall", {200, 100, 50});
  t.fold(40, 1);
  t.fold(250, 2);
  return t;
}

/** Bytes of numbers, in either order. */
class Bytes {
 public:
  explicit Bytes(bool bigEndian = false) : m_swaps(bigEndian) {}
  template <class T>
  Bytes& add(T value) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
    const std::size_t from = all.size();
    all.insert(all.end(), begin, begin + sizeof(T));
    if (m_swaps) std::reverse(all.begin() + static_cast<std::ptrdiff_t>(from), all.end());
    return *this;
  }
  std::vector<std::uint8_t> all;

 private:
  bool m_swaps;
};

RawCloud rawOf(const std::vector<std::uint8_t>& data, std::vector<RawCloud::Field> fields,
               std::uint32_t width, std::uint32_t step) {
  RawCloud raw;
  raw.fields = std::move(fields);
  raw.width = width, raw.height = 1, raw.pointStep = step, raw.rowStep = width * step;
  raw.data = data.data(), raw.size = data.size();
  return raw;
}

const std::vector<RawCloud::Field> kXyzLabel = {
    {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"label", 12, 4}};

TEST(PointFields, labelsAreRawIds) {
  Bytes bytes;
  bytes.add(1.0f).add(2.0f).add(3.0f).add(std::uint16_t(250));
  bytes.add(NAN).add(2.0f).add(3.0f).add(std::uint16_t(40));
  bytes.add(-1.0f).add(0.5f).add(0.0f).add(std::uint16_t(40));
  std::string problem;
  const auto cloud = cloudOf(rawOf(bytes.all, kXyzLabel, 3, 14), "label", table(), problem);
  EXPECT_EQ(problem, "");
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(-1, 0.5f, 0));
  EXPECT_EQ(cloud.classes, (std::vector<semantic_types::ClassId>{2, 1}));
}

TEST(PointFields, areReadInEitherOrderAndAnyType) {
  Bytes bytes(true);
  bytes.add(1.5).add(std::int16_t(-2)).add(3.0f).add(std::uint32_t(200 << 16 | 100 << 8 | 50));
  RawCloud raw = rawOf(bytes.all, {{"x", 0, 8}, {"y", 8, 3}, {"z", 10, 7}, {"rgb", 14, 7}}, 1, 18);
  raw.isBigEndian = true;
  std::string problem;
  const auto cloud = cloudOf(raw, "rgb", table(), problem);
  EXPECT_EQ(problem, "");
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.5f, -2, 3));
  EXPECT_EQ(cloud.classes, std::vector<semantic_types::ClassId>{2});
}

TEST(PointFields, pointsStayWhereClassesCannotBeRead) {
  Bytes bytes;
  bytes.add(1.0f).add(2.0f).add(3.0f).add(std::uint16_t(7));
  std::string problem;
  auto cloud = cloudOf(rawOf(bytes.all, kXyzLabel, 1, 14), "label", table(), problem);
  EXPECT_TRUE(contains(problem, "7")) << problem;
  EXPECT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud.classes, std::vector<semantic_types::ClassId>{0});
  cloud = cloudOf(rawOf(bytes.all, kXyzLabel, 1, 14), "id", table(), problem);
  EXPECT_TRUE(contains(problem, "no field 'id'")) << problem;
  EXPECT_EQ(cloud.size(), 1u);
  EXPECT_TRUE(cloud.classes.empty());
}

TEST(PointFields, zeroIsNoClassUnlessTheTableSaysSo) {
  const Bytes bytes = Bytes().add(1.0f).add(2.0f).add(3.0f).add(std::uint16_t(0));
  std::string problem;
  const RawCloud raw = rawOf(bytes.all, kXyzLabel, 1, 14);
  EXPECT_EQ(cloudOf(raw, "label", table(), problem).classes[0], 0);
  EXPECT_EQ(problem, "");
  ClassTable folded = table();
  folded.fold(0, 2);
  EXPECT_EQ(cloudOf(raw, "label", folded, problem).classes[0], 2);
}

TEST(PointFields, refuseWhatIsNoCloud) {
  const Bytes bytes = Bytes().add(1.0f).add(2.0f).add(3.0f).add(std::uint16_t(40));
  const auto refusal = [&](const std::function<void(RawCloud&)>& change) {
    RawCloud raw = rawOf(bytes.all, kXyzLabel, 1, 14);
    change(raw);
    std::string problem;
    return errorOf([&] { cloudOf(raw, "label", table(), problem); });
  };
  EXPECT_EQ(refusal([](RawCloud&) {}), "");
  EXPECT_TRUE(contains(refusal([](RawCloud& r) { r.fields[1].name = "b"; }), "no field 'y'"));
  EXPECT_TRUE(contains(refusal([](RawCloud& r) { r.fields[2].offset = 11; }), "outside"));
  EXPECT_TRUE(contains(refusal([](RawCloud& r) { r.fields[2].offset = 4294967295u; }), "outside"));
  EXPECT_TRUE(contains(refusal([](RawCloud& r) { r.fields[0].type = 9; }), "type 9"));
  EXPECT_TRUE(contains(refusal([](RawCloud& r) { r.width = 2; }), "14 bytes are no 2 x 1"));
  EXPECT_TRUE(
      contains(refusal([](RawCloud& r) { r.height = 2, r.rowStep = 0; }), "14 bytes are no 1 x 2"));
  EXPECT_TRUE(contains(refusal([](RawCloud& r) { r.width = r.height = r.rowStep = 4294967295u; }),
                       "bytes are no"));
}

/** The times of points with a field. \param fieldType sensor_msgs/PointField's number */
template <class T>
std::vector<float> timesWith(const std::string& name, int fieldType, const std::vector<T>& values) {
  Bytes bytes;
  for (const T value : values) bytes.add(1.0f).add(2.0f).add(3.0f).add(value);
  const std::vector<RawCloud::Field> fields = {
      {"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {name, 12, fieldType}};
  return timesOf(
      rawOf(bytes.all, fields, static_cast<std::uint32_t>(values.size()), 12 + sizeof(T)), 1.7e9);
}

}  // namespace

TEST(PointFields, timesAreThoseOfTheDriversThatAreKnown) {
  const std::vector<float> late = {0, 0.05f, 0.1f}, early = {-0.1f, -0.05f, 0};
  const auto areNear = [](const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
             return std::abs(x - y) < 1e-6f;
           });
  };
  EXPECT_TRUE(areNear(timesWith<std::uint32_t>("t", 6, {0, 50'000'000, 100'000'000}), late));
  EXPECT_TRUE(areNear(timesWith<float>("time", 7, {-0.1f, -0.05f, 0}), early));
  EXPECT_TRUE(
      areNear(timesWith<double>("timestamp", 8, {1.7e9 - 0.1, 1.7e9 - 0.05, 1.7e9}), early));
  EXPECT_TRUE(
      areNear(timesWith<double>("timestamp", 8, {1.7e18, 1.7e18 + 5e7, 1.7e18 + 1e8}), late));
  EXPECT_TRUE(timesWith<double>("time", 8, {0, 0.1, 3600}).empty()) << "no time within a second";
  EXPECT_TRUE(timesWith<double>("time", 8, {0, NAN}).empty());
  EXPECT_TRUE(timesWith<float>("intensity", 7, {0, 0.1f}).empty());
}

TEST(PointFields, pointsThatAreLeftOutHaveNoTimes) {
  Bytes bytes;
  for (const float x : {1.f, NAN, 3.f}) bytes.add(x).add(2.0f).add(3.0f).add(x / 10);
  const std::vector<RawCloud::Field> fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 7}};
  EXPECT_EQ(timesOf(rawOf(bytes.all, fields, 3, 16), 0), (std::vector<float>{0.1f, 0.3f}));
}
