#include <labeled_cloud/CObservationLabeledCloud.h>
#include <labeled_cloud/Rawlogs.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <strict_files/Memory.h>
#include <strict_files/Words.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "CompressedInputStream.h"

namespace labeled_cloud {

using mrpt::serialization::CSerializable;

RawlogReader::RawlogReader(const std::filesystem::path& file)
    : m_file(file), m_stream(std::make_unique<CompressedInputStream>(file)) {
  registerObservations();
}

RawlogReader::~RawlogReader() = default;

std::uint64_t RawlogReader::bytesRead() const { return m_stream->getPosition(); }

void RawlogReader::fail(const std::string& what) {
  m_ended = true;
  throw std::runtime_error(m_file.string() + ": " + what + " (object " +
                           std::to_string(m_objects + 1) + ", near byte " +
                           std::to_string(bytesRead()) + ")");
}

/** The next object, null at the end of a file that is whole. */
CSerializable::Ptr RawlogReader::readObject() {
  const std::uint64_t begin = m_stream->delivered();
  std::string problem;
  try {
    const strict_files::AllocationLimit limit;
    auto archive = mrpt::serialization::archiveFrom(*m_stream);
    if (auto object = archive.ReadObject()) return object;
    problem = "an empty object";
  } catch (const mrpt::serialization::CExceptionEOF& e) {
    if (m_stream->delivered() > begin) problem = "the file is cut off";
  } catch (const std::exception& e) {
    problem = strict_files::messageOf(e);
  }
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
    fail(std::string("a ") + object->GetRuntimeClass()->className + " does not belong in a rawlog");
  }
  ++m_objects;
  return entry;
}

namespace {

/** gzip's level, 1 to 9. Higher levels hardly shrink labeled clouds and take several times longer.
 */
constexpr int kCompression = 2;

}  // namespace

RawlogWriter::RawlogWriter(const std::filesystem::path& file)
    : m_file(file), m_stream(std::make_unique<GzipOutputStream>(m_file.path(), kCompression)) {}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::serialization::CSerializable& object) {
  auto archive = mrpt::serialization::archiveFrom(*m_stream);
  archive << object;
}

void RawlogWriter::finish() {
  m_stream->close();
  m_file.commit();
}

GzipOutputStream::GzipOutputStream(const std::filesystem::path& file, int compression)
    : m_path(file) {
  const std::string mode = "wb" + std::to_string(compression);
  m_file = gzopen(file.c_str(), mode.c_str());
  if (!m_file) fail();
}

GzipOutputStream::~GzipOutputStream() {
  if (m_file) gzclose_w(m_file);
}

std::size_t GzipOutputStream::Write(const void* buffer, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const auto piece = static_cast<unsigned>(std::min<std::size_t>(count - done, 1u << 30));
    const int written = gzwrite(m_file, static_cast<const char*>(buffer) + done, piece);
    if (written <= 0) fail();
    done += written;
  }
  m_taken += count;
  return count;
}

void GzipOutputStream::close() {
  const int result = gzclose_w(m_file);
  m_file = nullptr;
  if (result != Z_OK) fail();
}

void GzipOutputStream::fail() const {
  throw std::runtime_error(m_path.string() + ": cannot be written: " + std::strerror(errno));
}

std::size_t GzipOutputStream::Read(void*, std::size_t) {
  throw std::logic_error("GzipOutputStream: cannot be read from");
}

std::uint64_t GzipOutputStream::Seek(std::int64_t, TSeekOrigin) {
  throw std::logic_error("GzipOutputStream: cannot seek");
}

}  // namespace labeled_cloud
