#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace planning_study {

/** The main numbers of study.json as tables in Markdown. */
std::string toMarkdown(const nlohmann::ordered_json& study);

}  // namespace planning_study
