#include "Bag.h"

#include <algorithm>
#include <stdexcept>

namespace bags {

namespace fs = std::filesystem;

namespace {

bool isBag(const fs::path& file) {
  return file.extension() == ".mcap" || file.extension() == ".db3";
}

/** name_2 before name_10. */
bool comesFirst(const fs::path& a, const fs::path& b) {
  const std::string x = a.string(), y = b.string();
  return x.size() != y.size() ? x.size() < y.size() : x < y;
}

}  // namespace

std::vector<fs::path> filesOfBag(const fs::path& bag) {
  if (!fs::exists(bag)) throw std::runtime_error(bag.string() + ": there is no such bag");
  if (!fs::is_directory(bag)) {
    if (isBag(bag)) return {bag};
    throw std::runtime_error(bag.string() +
                             ": expected a bag of ROS 2, .mcap or .db3 (of .zst files: "
                             "unzstd first)");
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(bag))
    if (isBag(entry.path())) files.push_back(entry.path());
  if (files.empty())
    throw std::runtime_error(bag.string() + ": no .mcap or .db3 file is in this folder");
  std::sort(files.begin(), files.end(), comesFirst);
  return files;
}

void readBag(const fs::path& bag, const WantsTopic& wants, const TakeMessage& take) {
  bool goesOn = true;
  for (const fs::path& file : filesOfBag(bag)) try {
      if (!goesOn) return;
      const auto takeOne = [&](const BagTopic& topic, std::string_view message) {
        return goesOn = take(topic, message);
      };
      (file.extension() == ".mcap" ? readMcap : readSqliteBag)(file, wants, takeOne);
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(file.string() + ": " + e.what());
    }
}

std::set<BagTopic> topicsOfBag(const fs::path& bag) {
  std::set<BagTopic> topics;
  const auto note = [&topics](const BagTopic& topic) {
    topics.insert(topic);
    return false;
  };
  readBag(bag, note, [](const BagTopic&, std::string_view) { return true; });
  return topics;
}

}  // namespace bags
