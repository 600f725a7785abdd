#include <semantic_octree/TreeFile.h>
#include <strict_files/StagedFile.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "TreeFormat.h"

namespace semantic_octree {
namespace {

namespace fs = std::filesystem;

void writeWhole(const SemanticOcTree& tree, const fs::path& path) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  writeTree(out, tree);
  out.close();
  if (!out) throw std::runtime_error("the file could not be written completely");
}

/** What an error of a file says, without the path that it begins with. */
std::string reasonOf(const std::exception& error, const std::string& path) {
  const std::string message = error.what(), named = path + ": ";
  return message.rfind(named, 0) == 0 ? message.substr(named.size()) : message;
}

/** \return the version */
std::uint32_t readBeginning(std::istream& in) {
  std::array<char, kMagic.size()> magic{};
  readBytes(in, magic.data(), magic.size());
  if (magic != kMagic) throw std::runtime_error("not a semantic octree map");
  std::uint32_t version = 0;
  readBytes(in, reinterpret_cast<char*>(&version), sizeof(version));
  if (version < kOldestVersion || version > kVersion)
    throw std::runtime_error("version " + std::to_string(version) + " of the format, expected " +
                             std::to_string(kOldestVersion) + " or " + std::to_string(kVersion));
  return version;
}

SemanticOcTree readWhole(const fs::path& path) {
  if (fs::is_directory(path)) throw std::runtime_error("it is a folder");
  if (fs::exists(path) && !fs::is_regular_file(path))
    throw std::runtime_error("it is no file, but a device or a pipe");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(std::strerror(errno));
  if (in.peek() == std::ifstream::traits_type::eof()) throw std::runtime_error("the file is empty");
  SemanticOcTree tree = readTree(in);
  if (in.peek() != std::ifstream::traits_type::eof())
    throw std::runtime_error("altered: bytes after the end of the map");
  return tree;
}

}  // namespace

void writeTree(std::ostream& out, const SemanticOcTree& tree) {
  out.write(kMagic.data(), kMagic.size());
  out.write(reinterpret_cast<const char*>(&kVersion), sizeof(kVersion));
  TreeWriter(out, tree).write();
}

SemanticOcTree readTree(std::istream& in) {
  const std::uint32_t version = readBeginning(in);
  try {
    return TreeReader(in, version).read();
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(std::string("altered: ") + e.what());
  }
}

void saveTree(const SemanticOcTree& tree, const std::string& path) {
  try {
    strict_files::StagedFile file(path);
    writeWhole(tree, file.path());
    file.commit();
  } catch (const std::exception& e) {
    throw std::runtime_error("cannot save map '" + path + "': " + reasonOf(e, path));
  }
}

SemanticOcTree loadTree(const std::string& path) {
  try {
    return readWhole(path);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("cannot load map '" + path + "': " + e.what());
  }
}

}  // namespace semantic_octree
