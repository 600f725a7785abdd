#include <labeled_cloud/CObservationLabeledCloud.h>
#include <mrpt/serialization/CArchive.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

IMPLEMENTS_SERIALIZABLE(CObservationLabeledCloud, CObservation, labeled_cloud)

namespace labeled_cloud {

using mrpt::serialization::CArchive;
using semantic_types::ClassId;
using semantic_types::kMaxClasses;

void registerObservations() { mrpt::rtti::registerClass(CLASS_ID(CObservationLabeledCloud)); }

namespace {

/** Below IMPLEMENTS_SERIALIZABLE, which gives the class its name while statics are initialized;
 * MRPT_INITIALIZER may come before that. */
[[maybe_unused]] const bool kIsRegistered = (registerObservations(), true);

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "points are streamed as plain floats");

/** What follows the number of points in the stream. */
enum Content : std::uint8_t {
  kHasClasses = 1,
  kHasProbabilities = 2,
  kHasTimes = 4,
  kHasEmpty = 8
};

/** Reads COUNT values piece by piece: a corrupt count meets the end of the stream before it can
 * take more memory than there is data. */
template <typename T>
std::vector<T> readValues(CArchive& in, std::size_t count) {
  constexpr std::size_t kPiece = std::size_t(1) << 20;
  std::vector<T> values;
  while (values.size() < count) {
    const std::size_t begin = values.size();
    values.resize(begin + std::min(kPiece, count - begin));
    const std::size_t bytes = (values.size() - begin) * sizeof(T);
    if (in.ReadBuffer(values.data() + begin, bytes) != bytes)
      throw std::runtime_error("CObservationLabeledCloud: the stream ends within " +
                               std::to_string(count) + " announced values");
  }
  return values;
}

/** MRPT's WriteBuffer() takes nothing to write for an error. */
template <typename T>
void writeValues(CArchive& out, const T* values, std::size_t count) {
  if (count > 0) out.WriteBufferFixEndianness(values, count);
}

std::string readText(CArchive& in) {
  const auto text = readValues<char>(in, in.ReadAs<std::uint16_t>());
  return {text.begin(), text.end()};
}

void writeText(CArchive& out, const std::string& text) {
  if (text.size() > 0xffff)
    throw std::invalid_argument("CObservationLabeledCloud: a name of " +
                                std::to_string(text.size()) + " characters, at most 65535 fit");
  out.WriteAs<std::uint16_t>(text.size());
  writeValues(out, text.data(), text.size());
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("CObservationLabeledCloud: " + what);
}

std::string perPoint(std::size_t values, const char* what, std::size_t points) {
  return std::to_string(values) + what + std::to_string(points) + " points";
}

}  // namespace

void CObservationLabeledCloud::validate() const {
  const std::size_t n = cloud.size();
  if (!cloud.classes.empty() && cloud.classes.size() != n)
    refuse(perPoint(cloud.classes.size(), " classes for ", n));
  if (!cloud.probabilities.empty() && (n == 0 || cloud.probabilities.size() % n != 0 ||
                                       cloud.probabilities.size() / n > kMaxClasses))
    refuse(perPoint(cloud.probabilities.size(), " class probabilities for ", n));
  if (!times.empty() && times.size() != n) refuse(perPoint(times.size(), " times for ", n));
  if (!std::all_of(times.begin(), times.end(), [](float t) { return std::isfinite(t); }))
    refuse("a point whose time is no number");
  if (!(emptyFrom > 0)) refuse("no returns from " + std::to_string(emptyFrom) + " m on");
  if (classNames.size() > kMaxClasses) refuse(std::to_string(classNames.size()) + " class names");
  for (const std::string& name : classNames)
    if (const std::string shown = strict_files::printable(name); shown != name)
      refuse("the class name '" + shown + "' has control characters or is not UTF-8");
  const int limit = classNames.empty() ? kMaxClasses : static_cast<int>(classNames.size());
  const auto highest = std::max_element(cloud.classes.begin(), cloud.classes.end());
  if (highest != cloud.classes.end() && *highest > limit)
    refuse("class " + std::to_string(*highest) + " on a point, but classes are 1.." +
           std::to_string(limit));
}

/** The least version whose readers know all of it. */
std::uint8_t CObservationLabeledCloud::serializeGetVersion() const {
  return std::isfinite(emptyFrom) ? 2 : times.empty() ? 0 : 1;
}

void CObservationLabeledCloud::serializeTo(CArchive& out) const {
  validate();
  const std::size_t n = cloud.size();
  out << timestamp << sensorPose;
  writeText(out, sensorLabel);
  out.WriteAs<std::uint8_t>(classNames.size());
  for (const std::string& name : classNames) writeText(out, name);

  out.WriteAs<std::uint32_t>(n);
  out.WriteAs<std::uint8_t>((cloud.classes.empty() ? 0 : kHasClasses) |
                            (cloud.probabilities.empty() ? 0 : kHasProbabilities) |
                            (times.empty() ? 0 : kHasTimes) |
                            (std::isfinite(emptyFrom) ? kHasEmpty : 0));
  if (std::isfinite(emptyFrom)) out << emptyFrom;
  writeValues(out, reinterpret_cast<const float*>(cloud.points.data()), 3 * n);
  writeValues(out, times.data(), times.size());
  writeValues(out, cloud.classes.data(), cloud.classes.size());
  if (cloud.probabilities.empty()) return;
  out.WriteAs<std::uint8_t>(cloud.probabilities.size() / n);
  writeValues(out, cloud.probabilities.data(), cloud.probabilities.size());
}

void CObservationLabeledCloud::serializeFrom(CArchive& in, std::uint8_t version) {
  if (version > 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  CObservationLabeledCloud read;
  in >> read.timestamp >> read.sensorPose;
  read.sensorLabel = readText(in);
  read.classNames.resize(in.ReadAs<std::uint8_t>());
  for (std::string& name : read.classNames) name = readText(in);

  const std::size_t n = in.ReadAs<std::uint32_t>();
  const auto content = in.ReadAs<std::uint8_t>();
  if (version > 1 && content & kHasEmpty) in >> read.emptyFrom;
  read.cloud.points = readValues<Eigen::Vector3f>(in, n);
  if (content & kHasTimes) read.times = readValues<float>(in, n);
  if (content & kHasClasses) read.cloud.classes = readValues<ClassId>(in, n);
  if (content & kHasProbabilities)
    read.cloud.probabilities = readValues<float>(in, n * in.ReadAs<std::uint8_t>());
  read.validate();
  *this = std::move(read);
}

namespace {

void describeExtent(std::ostream& out, const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(INFINITY), high = -low;
  for (const auto& p : points)
    if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
  if (!(low.array() <= high.array()).all()) return;
  out << "Extent (sensor frame), m: x " << low.x() << " to " << high.x() << ", y " << low.y()
      << " to " << high.y() << ", z " << low.z() << " to " << high.z() << "\n";
}

}  // namespace

void CObservationLabeledCloud::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  out << "Sensor pose on the robot: " << sensorPose << "\nPoints: " << cloud.size() << "\n";
  describeExtent(out, cloud.points);
  if (!cloud.probabilities.empty() && !cloud.empty())
    out << "Soft labels over " << cloud.probabilities.size() / cloud.size() << " classes\n";
  if (cloud.classes.empty()) return;

  std::array<std::size_t, 256> count{};
  for (const ClassId id : cloud.classes) ++count[id];
  out << "Points per class:\n";
  for (std::size_t id = 0; id < count.size(); ++id) {
    if (count[id] == 0) continue;
    out << "  " << id << " ";
    if (id == 0) out << "(no class)";
    if (id > 0 && id <= classNames.size()) out << classNames[id - 1];
    out << ": " << count[id] << "\n";
  }
}

}  // namespace labeled_cloud
