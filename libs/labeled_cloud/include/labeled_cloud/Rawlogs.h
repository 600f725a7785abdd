#pragma once
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/CSerializable.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/OutputFiles.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

struct gzFile_s;  // zlib's

namespace labeled_cloud {

class CompressedInputStream;

/** One object of a rawlog: what the robot did, or what it saw. */
struct RawlogEntry {
  /** The robot's movement since the entry before; null if the entry holds observations. */
  mrpt::obs::CActionCollection::Ptr actions;
  /** All of a sensory frame, from the pose after the movement before, or a single one. */
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  /** The observations are a sensory frame. */
  bool isFrame = false;
};

/** Reads a rawlog of either kind (action/sensory-frame pairs or plain observations), compressed or
 * not, object by object: memory does not grow with the rawlog. The first one replaces OpenCV's
 * default allocator: while an object is read, no image may be larger than 400 MB. */
class RawlogReader {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit RawlogReader(const std::filesystem::path& file);
  ~RawlogReader();

  /** The next entry, or nothing at the end.
   * \throw std::runtime_error naming file, object and byte: no object at all, cut off, corrupt, or
   * an object of a class that is not registered or not of a rawlog. After that the reader is at its
   * end. */
  std::optional<RawlogEntry> next();

  /** Bytes read of the file, for progress. */
  std::uint64_t bytesRead() const;

 private:
  mrpt::serialization::CSerializable::Ptr readObject();
  [[noreturn]] void fail(const std::string& what);

  std::filesystem::path m_file;
  std::unique_ptr<CompressedInputStream> m_stream;
  std::size_t m_objects = 0;
  bool m_ended = false;
};

/** Writes objects into a gzip file. Unlike MRPT's own stream it tells when the disk is full. */
class GzipArchive : public mrpt::serialization::CArchive {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit GzipArchive(const std::filesystem::path& file);
  ~GzipArchive() override;
  GzipArchive(const GzipArchive&) = delete;
  GzipArchive& operator=(const GzipArchive&) = delete;

  /** Writes what is left; as `<<`, it throws if that cannot be.
   * \throw std::runtime_error naming the file */
  void close();

 private:
  std::size_t write(const void* buffer, std::size_t count) override;
  std::size_t read(void* buffer, std::size_t count) override;
  [[noreturn]] void fail() const;

  std::filesystem::path m_path;
  gzFile_s* m_file;
};

/** Writes a compressed rawlog, which appears under its name when it is complete. */
class RawlogWriter {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be written. */
  explicit RawlogWriter(const std::filesystem::path& file)
      : m_file(file), m_archive(m_file.path()) {}

  /** Appends an observation, a sensory frame or an action collection.
   * \throw std::exception what of the object cannot be written, or that the disk is full. */
  void write(const mrpt::serialization::CSerializable& object) { m_archive << object; }

  /** Completes the file; nothing can be written after it. Without it there will be no file.
   * \throw std::runtime_error naming the file, if it cannot be completed. */
  void finish();

 private:
  strict_files::StagedFile m_file;
  GzipArchive m_archive;
};

/** A class table of what the labels in some rawlogs say of themselves, for those that come without
 * one. It has the names of CObservationLabeledCloud and of pixelLabels in the order in which they
 * are met, and "class N" for ids without a name. Colors tell them apart. Empty if there are no
 * labels.
 * \throw std::runtime_error as RawlogReader does, and naming the rawlog: a name that a class table
 * does not take, or more than 254 classes. */
semantic_types::ClassTable classesIn(const std::vector<std::filesystem::path>& rawlogs);

}  // namespace labeled_cloud
