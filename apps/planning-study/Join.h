#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace planning_study {

/** Studies of several maps with the same options, each in a folder of its own, as one. */
struct JoinedStudy {
  nlohmann::ordered_json json;  ///< as toJson() would have given it
  std::string csv;              ///< as toCsv()
};

/** \throw std::runtime_error naming a folder whose files cannot be read, or whose options are not
 * those of the first. */
JoinedStudy joinStudies(const std::vector<std::filesystem::path>& folders);

}  // namespace planning_study
