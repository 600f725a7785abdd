#include "RawlogObjects.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPosePDF.h>

#include <strict_files/Words.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

namespace labeled_cloud {

using mrpt::obs::CAction;
using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;
using mrpt::rtti::TRuntimeClassId;
using mrpt::serialization::CSerializable;

/** Lists that grow take twice what is in them; pointers, short texts and particles need more than
 * they have in the file. */
bool CompressedInputStream::isInProportion(std::size_t piece) {
  constexpr std::size_t kLarge = 16 << 20, kSmallOnes = 64 << 20, kPerByte = 4,
                        kPerByteOfSmall = 64;
  if (piece > kLarge) return unpacksTo(piece / kPerByte);
  m_small += piece;
  return m_small <= kSmallOnes + kPerByteOfSmall * (m_delivered - m_begin);
}

bool CompressedInputStream::unpacksTo(std::uint64_t size) try {
  if (!m_ahead) m_ahead = std::make_unique<CompressedInputStream>(m_file);
  std::array<char, 1 << 14> some{};
  while (m_ahead->m_delivered < size)
    if (m_ahead->read(some.data(), some.size()) == 0) return false;
  return true;
} catch (const std::exception&) {
  return false;  // it is no longer there
}

namespace {

constexpr char kHasEnd = '\x80', kEnd = '\x88';  ///< in front of a class's name, behind its object

bool isA(const TRuntimeClassId* id, const TRuntimeClassId* kind) {
  return id && kind && id->derivedFrom(kind);
}

bool isValue(const TRuntimeClassId* id) {
  const std::string name = id->className;
  for (const char* space : {"mrpt::poses::", "mrpt::math::", "mrpt::img::"})
    if (name.rfind(space, 0) == 0) return true;
  return name == "mrpt::maps::TMapGenericParams" ||  // of a map of points
         isA(id, mrpt::rtti::findRegisteredClass("mrpt::maps::CPointsMap"));
}

}  // namespace

void RawlogObjects::expect(bool holds, const std::string& problem) {
  if (holds) return;
  if (m_problem.empty()) m_problem = problem;
  throw std::runtime_error(problem);
}

CSerializable::Ptr RawlogObjects::next() {
  char length = 0;
  if (take(&length, 1) == 0) return nullptr;
  expect((length & kHasEnd) != 0, "it is no rawlog, or of before MRPT 0.5.5");
  std::string name(length & 0x7f, '\0');
  expect(take(name.data(), name.size()) == name.size(), "the file is cut off");
  const TRuntimeClassId* id = mrpt::rtti::findRegisteredClass(name.c_str());
  if (id && id == CLASS_ID(CSensoryFrame)) return frame();
  if (id && id == CLASS_ID(CActionCollection)) return actions();
  m_begin = length + name;
  m_isWhole = true;
  CSerializable::Ptr object = ReadObject();
  expect(object != nullptr, "an empty object");
  return object;
}

/** As MRPT writes one: version, what old versions have, number, observations, a mark. */
CSensoryFrame::Ptr RawlogObjects::frame() {
  const int version = versionUpTo(2);
  if (version < 2) ReadAs<std::uint32_t>();  // its number
  std::optional<std::int64_t> stamp;
  if (version == 0) stamp = ReadAs<std::int64_t>();  // 100 ns since 1601
  auto frame = std::make_shared<CSensoryFrame>();
  for (const auto& observation : objects<CObservation>()) {
    if (stamp) observation->timestamp = mrpt::Clock::time_point(mrpt::Clock::duration(*stamp));
    frame->insert(observation);
  }
  return frame;
}

CActionCollection::Ptr RawlogObjects::actions() {
  versionUpTo(0);
  auto actions = std::make_shared<CActionCollection>();
  for (const auto& action : objects<CAction>()) actions->insert(*action);
  return actions;
}

int RawlogObjects::versionUpTo(int newest) {
  const int version = ReadAs<std::uint8_t>();
  expect(version <= newest, "a list of a version that is not known: " + std::to_string(version));
  return version;
}

template <class Object>
std::vector<std::shared_ptr<Object>> RawlogObjects::objects() {
  std::vector<std::shared_ptr<Object>> objects;
  for (auto n = ReadAs<std::uint32_t>(); n > 0; --n) {
    m_isWhole = true;
    objects.push_back(ReadObject<Object>());
    expect(objects.back() != nullptr, "what is in a list is nothing, or does not belong there");
  }
  expect(static_cast<char>(ReadAs<std::int8_t>()) == kEnd, "the end of a list is missing");
  return objects;
}

std::size_t RawlogObjects::take(char* buffer, std::size_t size) {
  const std::size_t first = m_begin.copy(buffer, size);
  m_begin.erase(0, first);
  return first < size ? first + m_stream.read(buffer + first, size - first) : first;
}

/** Whether an object of this class may come now. MRPT follows what a movement's estimate is, unless
 * the number in front of it says that it is odometry. */
bool RawlogObjects::mayCome(const std::string& className) {
  const TRuntimeClassId* id = mrpt::rtti::findRegisteredClass(className.c_str());  // as MRPT does
  const bool isOdometry = m_past == std::string(4, '\0');
  if (m_isMovement && !isOdometry && !isA(id, CLASS_ID(mrpt::poses::CPosePDF))) return false;
  m_isMovement = id && id == CLASS_ID(mrpt::obs::CActionRobotMovement2D);
  const bool isWhole = std::exchange(m_isWhole, false);
  if (isWhole && (isA(id, CLASS_ID(CObservation)) || isA(id, CLASS_ID(CAction)))) return true;
  return !id || isValue(id);
}

/** No bytes if there are none, or if they must not be read. */
std::size_t RawlogObjects::read(void* buffer, std::size_t size) {
  if (!m_problem.empty()) return 0;
  const std::size_t done = take(static_cast<char*>(buffer), size);
  if (done < size) m_problem = "the file is cut off";
  const std::string bytes(static_cast<const char*>(buffer), std::min<std::size_t>(done, 0x7f));
  const bool isName =
      m_last == std::string(1, static_cast<char>(kHasEnd | size)) ||
      (m_past == std::string(1, static_cast<char>(size)) && m_last == std::string(3, '\0'));  // old
  if (isName && !mayCome(bytes)) {
    m_problem = "a " + strict_files::printable(bytes) + " does not belong there";
    return 0;
  }
  m_past = std::exchange(m_last, bytes);
  return done;
}

std::size_t RawlogObjects::write(const void*, std::size_t) {
  throw std::logic_error("RawlogObjects: cannot be written to");
}

}  // namespace labeled_cloud
