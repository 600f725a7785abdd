#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <optional>

#include "map_window/Viewer.h"

namespace map_window {
class OrderList;
}

namespace semantic_map_view {

using namespace map_window;

/** Start, goal and the path between them. */
class PlanPanel {
 public:
  /** \param order of classes (YAML); empty: no paths */
  PlanPanel(Viewer& viewer, std::filesystem::path order, semantic_planning::VehicleOptions vehicle);
  PlanPanel(const PlanPanel&) = delete;
  PlanPanel& operator=(const PlanPanel&) = delete;

  /** Puts start or goal where the hand points. \return false: it means something else now. */
  bool place(const map_view::Ray& ray);
  /** Turns it to where the hand points now, if that is some way off. */
  void turn(const map_view::Ray& ray, bool letsGo);

 private:
  enum class Awaited { Nothing, Start, Goal };
  struct Pose {
    Eigen::Vector3d place;          ///< m, map frame
    std::optional<double> heading;  ///< rad; none: from start to goal
  };
  void await(Awaited what);
  std::optional<Pose>& awaited() { return m_awaited == Awaited::Start ? m_start : m_goal; }
  void plan();
  void begin();
  void forget();
  void readOrder();
  std::vector<std::string> rankNames() const;
  /** \param ranks of the order as it is, the best one first */
  void reorder(const std::vector<std::size_t>& ranks);
  void draw(const semantic_planning::PlanResult* plan);
  void say(const std::string& first, const std::string& second = {});

  Viewer& m_viewer;
  std::filesystem::path m_orderFile;
  semantic_planning::VehicleOptions m_vehicle;
  nanogui::Window* m_window;
  Awaited m_awaited = Awaited::Nothing;
  std::optional<Pose> m_start, m_goal;
  /** Planning keeps an abstraction of its own, and so a map of its own. */
  std::unique_ptr<semantic_octree::SemanticOcTree> m_map;
  std::optional<semantic_planning::SemanticPlanner> m_planner;
  /** Classes from best to worst, and how many the map has. */
  std::vector<std::vector<colored_graph::GraphClass>> m_ranks;
  int m_numClasses = 0;
  OrderList* m_order = nullptr;
  nanogui::Button *m_startButton = nullptr, *m_goalButton = nullptr;
  std::array<nanogui::Label*, 2> m_lines{};
  mrpt_compat::drawing::CSetOfObjects::Ptr m_marks = mrpt_compat::drawing::CSetOfObjects::Create();
};

}  // namespace semantic_map_view
