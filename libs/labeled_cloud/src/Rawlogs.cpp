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
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "PointLabels.h"

namespace labeled_cloud {

using mrpt::serialization::CSerializable;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::Color;

/** Reads a file that is compressed with Zstandard (RFC 8878), one frame after the other. */
class ZstdFile {
 public:
  /** Whether the file begins as such files do. */
  static bool isOne(const std::filesystem::path& file) {
    char begin[4] = {};
    std::ifstream(file, std::ios::binary).read(begin, 4);
    return std::string_view(begin, 4) == "\x28\xb5\x2f\xfd";
  }

  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit ZstdFile(const std::filesystem::path& file)
      : m_file(file, std::ios::binary),
        m_stream(ZSTD_createDStream()),
        m_piece(ZSTD_DStreamInSize()) {
    if (!m_file) throw std::runtime_error(file.string() + ": cannot be opened");
    if (!m_stream) throw std::bad_alloc();
  }

  /** \return how many bytes came: fewer at the end, and where the file is damaged. */
  std::size_t read(char* buffer, std::size_t count) {
    ZSTD_outBuffer output{buffer, count, 0};
    while (output.pos < count && m_damage.empty()) {
      if (m_input.pos == m_input.size) load();
      const std::size_t taken = m_input.pos, given = output.pos;
      const std::size_t left = ZSTD_decompressStream(m_stream.get(), &output, &m_input);
      if (ZSTD_isError(left)) {
        m_damage = ZSTD_getErrorName(left);
      } else if (m_input.pos == taken && output.pos == given) {  // the end of the file
        if (!m_frameIsWhole) m_damage = "the compressed data is cut off";
        break;
      } else {
        m_frameIsWhole = left == 0;
      }
    }
    return output.pos;
  }
  /** Bytes of the file taken so far, compressed. */
  std::uint64_t position() const { return m_loaded - (m_input.size - m_input.pos); }
  /** What is wrong with the data met so far, empty if nothing is. */
  const std::string& damage() const { return m_damage; }

 private:
  struct Free {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
  };
  void load() {
    m_file.read(m_piece.data(), static_cast<std::streamsize>(m_piece.size()));
    m_input = {m_piece.data(), static_cast<std::size_t>(m_file.gcount()), 0};
    m_loaded += m_input.size;
  }

  std::ifstream m_file;
  std::unique_ptr<ZSTD_DStream, Free> m_stream;
  std::vector<char> m_piece;
  ZSTD_inBuffer m_input{nullptr, 0, 0};
  std::uint64_t m_loaded = 0;
  bool m_frameIsWhole = true;
  std::string m_damage;
};

/** Reads a file compressed with gzip or, as later releases of MRPT write them, with Zstandard; a
 * plain one as it is.
 *
 * Unlike MRPT's own streams it tells a file that was cut off or altered from one that ends: after
 * the end of the data, damage() says what is wrong. It does not throw while reading, since MRPT
 * takes any exception in front of an object for the end of the file. */
class CompressedInputStream : public mrpt::io::CStream {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit CompressedInputStream(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file))
      throw std::runtime_error(file.string() + ": there is no such file");
    m_fileSize = std::filesystem::file_size(file);
    if (ZstdFile::isOne(file)) {
      m_zstd = std::make_unique<ZstdFile>(file);
      return;
    }
    m_gzip.reset(gzopen(file.c_str(), "rb"));
    if (!m_gzip) throw std::runtime_error(file.string() + ": cannot be opened");
    gzbuffer(m_gzip.get(), 1u << 18);
  }

  std::size_t Read(void* buffer, std::size_t count) override {
    char* const bytes = static_cast<char*>(buffer);
    const std::size_t done = m_zstd ? m_zstd->read(bytes, count) : readGzip(bytes, count);
    m_delivered += done;
    return done;
  }
  /** \throw std::logic_error always: this stream only reads, from the first byte to the last. */
  std::size_t Write(const void*, std::size_t) override {
    throw std::logic_error("CompressedInputStream: cannot be written to");
  }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override {
    throw std::logic_error("CompressedInputStream: cannot seek");
  }

  /** Size of the file, compressed. */
  std::uint64_t getTotalBytesCount() const override { return m_fileSize; }
  /** Bytes of the file taken so far, compressed. */
  std::uint64_t getPosition() const override {
    if (m_zstd) return m_zstd->position();
    return std::clamp<std::int64_t>(gzoffset(m_gzip.get()), 0, m_fileSize);
  }
  /** Bytes delivered so far. */
  std::uint64_t delivered() const { return m_delivered; }
  /** What is wrong with the compressed data met so far, empty if nothing is. */
  const std::string& damage() const { return m_zstd ? m_zstd->damage() : m_damage; }

 private:
  struct Close {
    void operator()(gzFile file) const { gzclose_r(file); }
  };
  std::size_t readGzip(char* buffer, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
      const std::size_t piece = std::min<std::size_t>(count - done, 1u << 30);
      const int got = gzread(m_gzip.get(), buffer + done, piece);
      noteDamage();
      if (got <= 0) break;
      done += got;
    }
    return done;
  }
  /** After each read: since zlib 1.3.2 the next one forgets it. */
  void noteDamage() {
    int code = Z_OK;
    const char* message = gzerror(m_gzip.get(), &code);
    if (code == Z_BUF_ERROR) m_damage = "the compressed data is cut off";
    if (code != Z_BUF_ERROR && code != Z_OK) m_damage = message;
  }

  std::unique_ptr<ZstdFile> m_zstd;         ///< of such a file
  std::unique_ptr<gzFile_s, Close> m_gzip;  ///< of any other
  std::uint64_t m_fileSize = 0, m_delivered = 0;
  std::string m_damage;
};

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

}  // namespace

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
    fail("a " + kindOf(*object) + " does not belong in a rawlog");
  }
  for (const auto& o : entry.observations)
    if (!hasFlags(*o)) fail("a flag of " + nameOf(*o) + " is neither 0 nor 1");
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
