#include <semantic_planning/planner/PlanResult.h>

namespace semantic_planning {

const strict_files::Choices<PlanStatus>& choicesOf(PlanStatus) {
  static const strict_files::Choices<PlanStatus> choices = {
      {"found", PlanStatus::Found},
      {"start off ground", PlanStatus::StartOffGround},
      {"start blocked", PlanStatus::StartBlocked},
      {"start forbidden", PlanStatus::StartForbidden},
      {"goal off ground", PlanStatus::GoalOffGround},
      {"goal blocked", PlanStatus::GoalBlocked},
      {"goal forbidden", PlanStatus::GoalForbidden},
      {"not connected", PlanStatus::NotConnected},
      {"only forbidden", PlanStatus::OnlyForbidden},
      {"cancelled", PlanStatus::Cancelled}};
  return choices;
}

const char* nameOf(PlanStatus status) { return strict_files::nameIn(choicesOf(status), status); }

}  // namespace semantic_planning
