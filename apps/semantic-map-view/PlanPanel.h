#pragma once
#include <semantic_planning/planner/SemanticPlanner.h>

#include <optional>

#include "map_window/Viewer.h"

namespace semantic_map_view {

using namespace map_window;

/** Start, goal and the path between them; by which order of classes, and for which vehicle. */
class PlanPanel {
 public:
  /** \param order of classes (YAML); empty: none is allowed until a hand chooses some
   * \param vehicle (YAML); empty: a small robot */
  PlanPanel(Viewer& viewer, std::filesystem::path order, const std::filesystem::path& vehicle);
  PlanPanel(const PlanPanel&) = delete;

  /** An order of classes, or a vehicle (YAML), by which is planned from now on.
   * \return what it is \throw std::runtime_error naming file, line and value */
  std::string open(const std::filesystem::path& file);
  /** Puts start or goal where the hand points. \return false: it means something else now. */
  bool place(const map_view::Ray& ray);
  /** Turns it to where the hand points now, if that is some way off. */
  void turn(const map_view::Ray& ray, bool letsGo);

 private:
  using Ranks = std::vector<std::vector<colored_graph::GraphClass>>;
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
  /** Ranks, the best one first, then the classes of the map that are forbidden. */
  void listClasses();
  void addLine(const std::string& name, bool isAllowed, std::size_t rank,
               colored_graph::GraphClass id);
  /** Changes the ranks before the next frame (what changes them is drawn anew), and plans. */
  void change(const std::function<void(Ranks&)>& f);
  std::string nameOf(colored_graph::GraphClass id) const;
  std::string nameOf(const std::vector<colored_graph::GraphClass>& rank) const;
  void planAnew();
  void draw(const semantic_planning::PlanResult* plan);
  void say(const std::string& first, const std::string& second = {});

  Viewer& m_viewer;
  std::filesystem::path m_orderFile;
  semantic_planning::VehicleOptions m_vehicle;
  Awaited m_awaited = Awaited::Nothing;
  std::optional<Pose> m_start, m_goal;
  /** Planning keeps an abstraction of its own, and so a map of its own. */
  std::unique_ptr<semantic_octree::SemanticOcTree> m_map;
  std::optional<semantic_planning::SemanticPlanner> m_planner;
  Ranks m_ranks;
  /** The file's order as long as nobody has changed it. */
  std::optional<colored_graph::ClassOrder> m_order;
  std::function<void(Ranks&)> m_change;
  nanogui::Widget* m_list;
  std::array<nanogui::Label*, 2> m_lines{};
  nanogui::Label* m_vehicleName;
  mrpt_compat::drawing::CSetOfObjects::Ptr m_marks = mrpt_compat::drawing::CSetOfObjects::Create();
};

}  // namespace semantic_map_view
