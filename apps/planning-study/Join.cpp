#include "Join.h"

#include <strict_files/TextFile.h>

#include <stdexcept>

namespace planning_study {

using nlohmann::ordered_json;

namespace {

ordered_json studyIn(const std::filesystem::path& folder) {
  try {
    const ordered_json study = ordered_json::parse(strict_files::readText(folder / "study.json"));
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
    const std::string csv = strict_files::readText(folder / "study.csv");
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
