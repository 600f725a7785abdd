#pragma once
#include <nlohmann/json.hpp>

#include "Trial.h"

namespace drive_study {

/** A line for each drive. */
std::string toCsv(const std::vector<Trial>& trials);
/** Each scene's numbers, and those of all. */
nlohmann::ordered_json toJson(const std::vector<Trial>& trials);

}  // namespace drive_study
