#include <semantic_planning/planner/PlanResult.h>

namespace semantic_planning {

const char* nameOf(PlanStatus status) {
  switch (status) {
    case PlanStatus::Found:
      return "found";
    case PlanStatus::StartOffGround:
      return "start off ground";
    case PlanStatus::StartBlocked:
      return "start blocked";
    case PlanStatus::StartForbidden:
      return "start forbidden";
    case PlanStatus::GoalOffGround:
      return "goal off ground";
    case PlanStatus::GoalBlocked:
      return "goal blocked";
    case PlanStatus::GoalForbidden:
      return "goal forbidden";
    case PlanStatus::NotConnected:
      return "not connected";
    case PlanStatus::OnlyForbidden:
      return "only forbidden";
    case PlanStatus::Cancelled:
      return "cancelled";
    case PlanStatus::TimeLimit:
      return "time limit";
  }
  return "";
}

}  // namespace semantic_planning
