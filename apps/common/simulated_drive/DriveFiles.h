#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "DriveLoop.h"

namespace simulated_drive {

/** A line for each step of the control. */
std::string toCsv(const DriveRecord& record);

/** What the whole drive comes to. */
nlohmann::json toJson(const DriveRecord& record, const colored_graph::ClassOrder& order);

/** Meters in classes of a rank but the best, and in forbidden ones; of lengths by class id. */
double badLength(const std::vector<double>& perClass, const colored_graph::ClassOrder& order);

}  // namespace simulated_drive
