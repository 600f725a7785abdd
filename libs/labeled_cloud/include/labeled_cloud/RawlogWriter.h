#pragma once
#include <mrpt/serialization/CSerializable.h>
#include <strict_files/StagedFile.h>

#include <filesystem>
#include <memory>

namespace labeled_cloud {

class GzipOutputStream;

/** Writes a compressed rawlog, which appears under its name when it is complete. */
class RawlogWriter {
 public:
  /** \throw std::runtime_error naming the file, if it cannot be written. */
  explicit RawlogWriter(const std::filesystem::path& file);
  ~RawlogWriter();

  /** Appends an observation, a sensory frame or an action collection.
   * \throw std::exception what of the object cannot be written, or that the disk is full. */
  void write(const mrpt::serialization::CSerializable& object);

  /** Completes the file; nothing can be written after it. Without it there will be no file.
   * \throw std::runtime_error naming the file, if it cannot be completed. */
  void finish();

 private:
  strict_files::StagedFile m_file;
  std::unique_ptr<GzipOutputStream> m_stream;
};

}  // namespace labeled_cloud
