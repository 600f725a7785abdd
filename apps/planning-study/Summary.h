#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "Study.h"

namespace planning_study {

/** Everything about all maps: each way to plan, and pairs of ways. The first graph is compared with
 * each other one (kept with cold ones, too: memory is of no use to all), each judgment of a graph
 * with "profile", and the first graph with the peers. */
nlohmann::ordered_json toJson(const std::vector<MapStudy>& maps, const StudyOptions& options);

/** One line a trial; the first line names the columns. Times are in the columns that end with
 * "[ms]", and the peers depend on them. */
std::string toCsv(const std::vector<MapStudy>& maps);

}  // namespace planning_study
