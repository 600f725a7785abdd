#pragma once
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>

/** Writes a rawlog of these objects, through MRPT's own streams. */
template <typename Stream = mrpt::io::CFileGZOutputStream>
std::filesystem::path writeRawlog(
    const std::filesystem::path& file,
    const std::vector<mrpt::serialization::CSerializable::Ptr>& objects) {
  Stream stream(file.string());
  auto archive = mrpt::serialization::archiveFrom(stream);
  for (const auto& object : objects) archive << *object;
  return file;
}
