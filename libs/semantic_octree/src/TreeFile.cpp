#include <semantic_octree/TreeFile.h>

#include <strict_files/OutputFiles.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <streambuf>

#include "TreeContent.h"

namespace semantic_octree {
namespace {

namespace fs = std::filesystem;
using strict_files::StagedFile;

void writeBeginning(std::ostream& out) {
  out.write(kMagic.data(), kMagic.size());
  out.write(reinterpret_cast<const char*>(&kVersion), sizeof(kVersion));
}

/** Counts what is written to it. */
class CountingBuffer : public std::streambuf {
 public:
  std::size_t bytes() const { return m_bytes; }

 private:
  int_type overflow(int_type c) override {
    ++m_bytes;
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char*, std::streamsize n) override {
    m_bytes += static_cast<std::size_t>(n);
    return n;
  }
  std::size_t m_bytes = 0;
};

/** What an error of a file says, without the path that it begins with. */
std::string reasonOf(const std::exception& error, const std::string& path) {
  const std::string message = error.what(), named = path + ": ";
  return message.rfind(named, 0) == 0 ? message.substr(named.size()) : message;
}

void readBeginning(std::istream& in) {
  std::array<char, kMagic.size()> magic{};
  readBytes(in, magic.data(), magic.size());
  if (magic != kMagic) throw std::runtime_error("not a semantic octree map");
  std::uint32_t version = 0;
  readBytes(in, reinterpret_cast<char*>(&version), sizeof(version));
  if (version != kVersion)
    throw std::runtime_error("version " + std::to_string(version) + " of the format, expected " +
                             std::to_string(kVersion));
}

/** Calls read(stream), which has to read all of the file. */
template <typename F>
auto readWhole(const fs::path& path, const F& read) {
  if (fs::is_directory(path)) throw std::runtime_error("it is a folder");
  if (fs::exists(path) && !fs::is_regular_file(path))
    throw std::runtime_error("it is no file, but a device or a pipe");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(std::strerror(errno));
  if (in.peek() == std::ifstream::traits_type::eof()) throw std::runtime_error("the file is empty");
  auto content = read(in);
  if (in.peek() != std::ifstream::traits_type::eof())
    throw std::runtime_error("altered: bytes after the end of the map");
  return content;
}

/** Calls read(), for what is behind the beginning. */
template <typename F>
auto readBehindBeginning(std::istream& in, const F& read) {
  readBeginning(in);
  try {
    return read();
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(std::string("altered: ") + e.what());
  }
}

SemanticOcTree readAll(std::istream& in, std::uint32_t* checksum) {
  return readBehindBeginning(in, [&] { return readContent(in, checksum); });
}

std::uint32_t write(std::ostream& out, const SemanticOcTree& tree) {
  writeBeginning(out);
  return writeContent(out, tree);
}

/** Calls write(stream), which tells the checksum. */
template <typename F>
std::uint32_t save(const std::string& path, StagedFile::Disk when, const F& write) {
  try {
    StagedFile file(path);
    errno = 0;
    std::ofstream out(file.path(), std::ios::binary | std::ios::trunc);
    const std::uint32_t checksum = write(out);
    out.close();
    if (!out)
      throw std::runtime_error("the file could not be written completely: " +
                               std::string(std::strerror(errno)));
    file.commit(when);
    return checksum;
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot save map '" + path + "': " + reasonOf(e, path));
  }
}

template <typename F>
auto load(const std::string& path, const F& read) {
  try {
    return readWhole(path, read);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("cannot load map '" + path + "': " + e.what());
  }
}

}  // namespace

void writeTree(std::ostream& out, const SemanticOcTree& tree) { write(out, tree); }

std::size_t fileSize(const SemanticOcTree& tree) {
  CountingBuffer buffer;
  std::ostream out(&buffer);
  writeTree(out, tree);
  return buffer.bytes();
}

SemanticOcTree readTree(std::istream& in) { return readAll(in, nullptr); }

void saveTree(const SemanticOcTree& tree, const std::string& path) {
  save(path, StagedFile::Disk::Now, [&](std::ostream& out) { return write(out, tree); });
}

std::uint32_t saveTreeFile(const SemanticOcTree& tree, const std::string& path) {
  return save(path, StagedFile::Disk::Later, [&](std::ostream& out) { return write(out, tree); });
}

SemanticOcTree loadTree(const std::string& path) { return loadTreeFile(path); }

SemanticOcTree loadTreeFile(const std::string& path, std::uint32_t* checksum) {
  return load(path, [&](std::istream& in) { return readAll(in, checksum); });
}

std::uint32_t saveTile(const SemanticOcTree& tree, const Slot& octant, const Cube& cell,
                       std::uint64_t nodes, const std::string& path) {
  return save(path, StagedFile::Disk::Later, [&](std::ostream& out) {
    writeBeginning(out);
    return writeTileContent(out, tree, octant, cell, nodes);
  });
}

std::uint32_t loadTile(const SemanticOcTree& tree, NodeArena& arena, Octant& octant,
                       const Cube& cell, const std::string& path) {
  return load(path, [&](std::istream& in) {
    return readBehindBeginning(in, [&] { return readTileContent(in, tree, arena, octant, cell); });
  });
}

std::uint32_t extendCrc(std::uint32_t crc, const void* bytes, std::size_t size) {
  return static_cast<std::uint32_t>(crc32_z(crc, static_cast<const unsigned char*>(bytes), size));
}

}  // namespace semantic_octree
