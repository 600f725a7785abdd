#include <labeled_cloud/Rawlogs.h>

#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt_compat/Images.h>
#include <strict_files/Memory.h>
#include <strict_files/Words.h>
#include <zlib.h>
#include <opencv2/core/mat.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "CompressedInputStream.h"
#include "PointLabels.h"
#include "RawlogObjects.h"

namespace labeled_cloud {

using mrpt::serialization::CSerializable;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;

namespace {

/** MRPT reads flags as the bytes that they are. */
bool isFlag(const bool& flag) {
  unsigned char byte = 0;
  std::memcpy(&byte, &flag, 1);
  return byte <= 1;
}

bool hasFlags(const mrpt::obs::CObservation& observation) {
  if (const auto* o = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation))
    return isFlag(o->hasPoints3D) && isFlag(o->hasRangeImage) && isFlag(o->range_is_depth) &&
           isFlag(o->hasIntensityImage) && isFlag(o->hasConfidenceImage);
  const auto* o = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation);
  return !o || isFlag(o->rightToLeft);
}

using strict_files::AllocationLimit;

/** OpenCV's allocator, but a thread with a limit gets no larger image than one of 16384 x 8192
 * colors: a JPEG of a few bytes says of itself what it likes. */
class LimitedImages : public cv::MatAllocator {
  cv::UMatData* allocate(int dimensions, const int* sizes, int type, void* data, std::size_t* steps,
                         cv::AccessFlag access, cv::UMatUsageFlags usage) const override {
    constexpr double kMost = 3.0 * 16384 * 8192;
    double bytes = CV_ELEM_SIZE(type);
    for (int i = 0; i < dimensions; ++i) bytes *= sizes[i];
    if (bytes > kMost && !AllocationLimit::isAllowed(AllocationLimit::kMost + 1))
      throw strict_files::PieceTooLarge();
    return usual().allocate(dimensions, sizes, type, data, steps, access, usage);
  }
  bool allocate(cv::UMatData* data, cv::AccessFlag access,
                cv::UMatUsageFlags usage) const override {
    return usual().allocate(data, access, usage);
  }
  void deallocate(cv::UMatData* data) const override { usual().deallocate(data); }

  static cv::MatAllocator& usual() { return *cv::Mat::getStdAllocator(); }
};

/** For this process: images outlive readers. */
void limitImages() {
  [[maybe_unused]] static const bool isDone =
      (cv::Mat::setDefaultAllocator(new LimitedImages), true);
}

}  // namespace

RawlogReader::RawlogReader(const std::filesystem::path& file)
    : m_file(file), m_stream(std::make_unique<CompressedInputStream>(file)) {
  registerObservations();
  limitImages();
}

RawlogReader::~RawlogReader() = default;

std::uint64_t RawlogReader::bytesRead() const { return m_stream->position(); }

void RawlogReader::fail(const std::string& what) {
  m_ended = true;
  throw std::runtime_error(m_file.string() + ": " + what + " (object " +
                           std::to_string(m_objects + 1) + ", near byte " +
                           std::to_string(bytesRead()) + ")");
}

/** The next object, null at the end of a file that is whole. */
CSerializable::Ptr RawlogReader::readObject() {
  RawlogObjects archive(*m_stream);
  std::string problem;
  try {
    const AllocationLimit limit(m_stream->allows());
    if (auto object = archive.next()) return object;
  } catch (const std::exception& e) {
    problem = strict_files::messageOf(e);
  }
  if (!archive.problem().empty()) problem = archive.problem();
  if (!m_stream->damage().empty()) problem = m_stream->damage();
  if (!problem.empty()) fail(problem);
  if (m_objects == 0) fail("the rawlog is empty");
  m_ended = true;
  return nullptr;
}

std::optional<RawlogEntry> RawlogReader::next() {
  if (m_ended) return std::nullopt;
  const CSerializable::Ptr object = readObject();
  if (!object) return std::nullopt;

  RawlogEntry entry;
  if (const auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
    entry.actions = actions;
  } else if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
    entry.observations.assign(frame->begin(), frame->end());
    entry.isFrame = true;
  } else if (const auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
    entry.observations.push_back(observation);
  } else {
    fail("a " + kindOf(*object) + " does not belong in a rawlog");
  }
  for (const auto& o : entry.observations)
    if (!hasFlags(*o)) fail("a flag of " + nameOf(*o) + " is neither 0 nor 1");
  ++m_objects;
  return entry;
}

/** Of gzip's levels, 1 to 9, higher ones hardly shrink labeled clouds and take several times
 * longer.
 */
GzipArchive::GzipArchive(const std::filesystem::path& file)
    : m_path(file), m_file(gzopen(file.c_str(), "wb2")) {
  if (!m_file) fail();
}

GzipArchive::~GzipArchive() {
  if (m_file) gzclose_w(m_file);
}

std::size_t GzipArchive::write(const void* buffer, std::size_t count) {
  if (gzfwrite(buffer, 1, count, m_file) != count) fail();
  return count;
}

std::size_t GzipArchive::read(void*, std::size_t) {
  throw std::logic_error("GzipArchive: cannot be read from");
}

void GzipArchive::close() {
  if (gzclose_w(std::exchange(m_file, nullptr)) != Z_OK) fail();
}

void GzipArchive::fail() const {
  throw std::runtime_error(m_path.string() + ": cannot be written: " + std::strerror(errno));
}

void RawlogWriter::finish() {
  m_archive.close();
  m_file.commit();
}

namespace {

/** Hues that stay apart however many there are: each turns by the golden ratio. */
Color colorOfNumber(int number) {
  const double hue = std::fmod(number * 0.6180339887498949, 1.0);
  const auto color =
      mrpt_compat::colorOfHue(static_cast<float>(hue), 0.7f, number % 2 ? 0.9f : 0.65f);
  const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(255 * x)); };
  return {byte(color.R), byte(color.G), byte(color.B)};
}

class Collector {
 public:
  void add(const mrpt::obs::CObservation& observation) {
    if (const auto* cloud = dynamic_cast<const CObservationLabeledCloud*>(&observation))
      addCloud(*cloud);
    else if (const auto* scan =
                 dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation))
      if (scan->pixelLabels) addPixels(*scan->pixelLabels);
  }
  const ClassTable& table() const { return m_table; }

 private:
  void addCloud(const CObservationLabeledCloud& cloud) {
    for (const std::string& name : cloud.classNames) addName(name);
    if (!cloud.classNames.empty() || cloud.cloud.classes.empty()) return;
    const ClassId highest =
        *std::max_element(cloud.cloud.classes.begin(), cloud.cloud.classes.end());
    for (int id = 1; id <= highest; ++id) addName("class " + std::to_string(id));
  }
  void addPixels(const mrpt::obs::TPixelLabelInfoBase& labels) {
    for (const auto& [id, name] : labels.pixelLabelNames) addName(name);
  }
  void addName(const std::string& name) {
    if (!m_table.find(name)) m_table.add(name, colorOfNumber(m_table.size()));
  }

  ClassTable m_table;
};

}  // namespace

ClassTable classesIn(const std::vector<std::filesystem::path>& rawlogs) {
  Collector collector;
  for (const std::filesystem::path& file : rawlogs) {
    RawlogReader reader(file);
    try {
      while (const auto entry = reader.next())
        for (const auto& observation : entry->observations) collector.add(*observation);
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ": " + e.what());
    }
  }
  return collector.table();
}

}  // namespace labeled_cloud
