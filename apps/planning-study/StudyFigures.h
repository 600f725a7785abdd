#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>

namespace planning_study {

// Figures of study.json, one column for each map, judgment "profile", drawn with gnuplot into a PNG
// file. All: \throw std::runtime_error as figures::drawWithGnuplot().

/** Box plots of the planning time of the tasks that were solved (quartiles, whiskers from the 5th
 * to the 95th percentile, median) over the budget of vertices: above of planners that forget,
 * below of planners that remember. */
void drawTimes(const nlohmann::ordered_json& study, const std::filesystem::path& file);

/** Above the success, below the meters outside the best rank, of the tasks that were solved, over
 * the budget of vertices. */
void drawPaths(const nlohmann::ordered_json& study, const std::filesystem::path& file);

}  // namespace planning_study
