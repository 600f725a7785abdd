#include "Complaints.h"

#include <strict_files/Words.h>

#include <cstring>
#include <iostream>

namespace semantic_map_ros2 {

namespace {
constexpr std::size_t kMostKinds = 100, kLongest = 1000;  // peers cannot fill memory

/** Names of peers may be long, and have lines. */
std::string shown(const std::string& text) {
  return strict_files::printable(text.substr(0, kLongest));
}

/** A text without its numbers; digits within names stay. */
std::string kindOf(const std::string& text) {
  std::string kind;
  for (const char c : text) {
    const bool isOfNumber = std::strchr("0123456789.-", c) && c != '\0';
    const bool isInName = !kind.empty() && !std::strchr(" (,", kind.back());
    if (!isOfNumber || isInName) kind += c;
  }
  return kind;
}

}  // namespace

void Complaints::say(const std::string& what, const std::string& details) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  const std::string words = shown(what), kind = kindOf(words);
  if (m_said.size() >= kMostKinds && m_said.count(kind) == 0) return;
  Said& said = m_said.emplace(kind, Said{words, 0}).first->second;
  if (++said.count > 1) return;
  std::cerr << "Warning: " << words;
  if (!details.empty()) std::cerr << " (" << shown(details) << ')';
  std::cerr << std::endl;
}

void Complaints::sum() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  for (const auto& [kind, said] : m_said)
    if (said.count > 1)
      std::cerr << "Warning: " << said.count << " times: " << said.what << std::endl;
}

}  // namespace semantic_map_ros2
