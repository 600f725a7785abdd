#include "Join.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace planning_study {

using nlohmann::ordered_json;

namespace {

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw std::runtime_error(file.string() + ": cannot be read");
  return text.str();
}

ordered_json studyIn(const std::filesystem::path& folder) {
  try {
    const ordered_json study = ordered_json::parse(textOf(folder / "study.json"));
    study.at("options"), study.at("maps").at(0);
    return study;
  } catch (const ordered_json::exception& e) {
    throw std::runtime_error((folder / "study.json").string() + ": no study: " + e.what());
  }
}

}  // namespace

JoinedStudy joinStudies(const std::vector<std::filesystem::path>& folders) {
  JoinedStudy joined;
  for (const auto& folder : folders) {
    const ordered_json study = studyIn(folder);
    const std::string csv = textOf(folder / "study.csv");
    if (joined.json.is_null()) {
      joined = {study, csv};
      continue;
    }
    if (study["options"] != joined.json["options"])
      throw std::runtime_error(folder.string() + ": studied with other options than " +
                               folders.front().string());
    for (const ordered_json& map : study["maps"]) joined.json["maps"].push_back(map);
    joined.csv += csv.substr(csv.find('\n') + 1);
  }
  return joined;
}

}  // namespace planning_study
