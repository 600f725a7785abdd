#pragma once
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace labeled_cloud {

class CompressedInputStream;

/** One object of a rawlog: what the robot did, or what it saw. */
struct RawlogEntry {
  /** The robot's movement since the entry before; null if the entry holds observations. */
  mrpt::obs::CActionCollection::Ptr actions;
  /** Those of a sensory frame (all from the pose after the movement before), or a single one. */
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  /** The observations are a sensory frame. */
  bool isFrame = false;
};

/** Reads a rawlog of either kind (action/sensory-frame pairs or plain observations), compressed or
 * not, object by object: memory does not grow with the rawlog. */
class RawlogReader {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be opened. */
  explicit RawlogReader(const std::filesystem::path& file);
  ~RawlogReader();

  /** The next entry, or nothing at the end.
   * \throw std::runtime_error naming the file, the number of the object and the byte: no object at
   * all, cut off, corrupt, or an object of a class that is not registered or not of a rawlog.
   * After that the reader is at its end. */
  std::optional<RawlogEntry> next();

  /** Bytes read of the file, and its size, for progress. */
  std::uint64_t bytesRead() const;
  std::uint64_t bytesTotal() const;

 private:
  mrpt::serialization::CSerializable::Ptr readObject();
  [[noreturn]] void fail(const std::string& what);

  std::filesystem::path m_file;
  std::unique_ptr<CompressedInputStream> m_stream;
  std::size_t m_objects = 0;
  bool m_ended = false;
};

}  // namespace labeled_cloud
