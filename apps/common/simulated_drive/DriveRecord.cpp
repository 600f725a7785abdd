#include "DriveRecord.h"

#include <algorithm>

namespace simulated_drive {

const strict_files::Choices<DriveEnd>& choicesOf(DriveEnd) {
  static const strict_files::Choices<DriveEnd> choices = {
      {"arrived", DriveEnd::Arrived},      {"nearest", DriveEnd::Nearest},
      {"astray", DriveEnd::Astray},        {"unreachable", DriveEnd::Unreachable},
      {"time_limit", DriveEnd::TimeLimit}, {"stopped", DriveEnd::Stopped},
      {"explored", DriveEnd::Explored}};
  return choices;
}

const char* nameOf(DriveEnd end) { return strict_files::nameIn(choicesOf(end), end); }

void DriveRecord::add(const DriveRow& row, std::optional<semantic_types::ClassId> planned,
                      double way) {
  drivenPerClass[row.classId] += way;
  if (planned) plannedPerClass[*planned] += way;
  length += way;
  const bool touchedBefore = !rows.empty() && rows.back().clearance <= 0;
  if (row.clearance <= 0 && !touchedBefore) ++collisions;
  leastClearance = std::min(leastClearance, row.clearance);
  rows.push_back(row);
}

}  // namespace simulated_drive
