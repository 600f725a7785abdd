#include "PlanPanel.h"

#include <map_view/OrbitCamera.h>
#include <mrpt/core/format.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>
#include <strict_files/TextFile.h>

#include <cmath>
#include <ostream>
#include <utility>

#include "FilesPanel.h"
#include "Terminal.h"
#include "Track.h"
#include "map_window/Widgets.h"
#include "measuring/Measuring.h"

namespace semantic_map_view {

using mrpt::math::TPoint3Df;
using mrpt::math::TPose2D;
using mrpt_compat::drawing::CSetOfTriangles;
using mrpt_compat::drawing::TTriangle;
using semantic_planning::PlanResult;

namespace {

constexpr int kPlanWidth = 280;
constexpr double kTurn = 0.5;  // m from the place, at least, where the hand gives a heading
constexpr mrpt::img::TColor kStartColor{40, 90, 220}, kGoalColor{220, 40, 40};

/** As the files of plans say it. */
std::vector<Track::Point> pointsOf(const PlanResult& plan) {
  std::vector<Track::Point> points;
  for (const auto& p : plan.path)
    points.push_back({{p.x, p.y, p.z}, p.forward ? Track::Gear::Forward : Track::Gear::Backward});
  return points;
}

/** A flat triangle, six times as long as wide. */
CSetOfTriangles::Ptr arrowAt(const Eigen::Vector3d& place, double heading,
                             const mrpt::img::TColor& color, float width) {
  const TPoint3Df base(float(place.x()), float(place.y()), float(place.z()) + kLift),
      along(float(std::cos(heading)), float(std::sin(heading)), 0), aside(-along.y, along.x, 0);
  TTriangle triangle(base - aside * width, base + along * (12 * width), base + aside * width);
  triangle.setColor(color);
  const auto arrow = CSetOfTriangles::Create();
  arrow->insertTriangle(triangle);
  arrow->enableLight(false);
  return arrow;
}

/** Where a ray that looks down meets a height; else its origin. */
Eigen::Vector3d atHeight(const map_view::Ray& ray, double z) {
  const double steps = ray.direction.z() < 0 ? (z - ray.origin.z()) / ray.direction.z() : 0;
  return ray.origin + steps * ray.direction;
}

mrpt_compat::drawing::CCylinder::Ptr postAt(const Eigen::Vector3d& place,
                                            const mrpt::img::TColor& color, float width) {
  const auto post = mrpt_compat::drawing::CCylinder::Create(width, width, 4.f);
  post->setLocation(place.x(), place.y(), place.z());
  post->setColor_u8(color);
  return post;
}

}  // namespace

PlanPanel::PlanPanel(Viewer& viewer, std::filesystem::path orderFile,
                     const std::filesystem::path& vehicle)
    : m_viewer(viewer), m_orderFile(std::move(orderFile)) {
  auto* content = viewer.window()
                      .addPanel(ViewWindow::Side::Right, "Path", kPlanWidth, !m_orderFile.empty())
                      ->content();
  auto* row = addRow(content);
  addButton(row, "start", 90, [this] { await(Awaited::Start); });
  addButton(row, "goal", 90, [this] { await(Awaited::Goal); });
  addText(content, "may drive on, best first:", kPlanWidth);
  m_list = addScroll(content, kPlanWidth, 110);
  m_vehicleName = addText(content, "vehicle: small robot", kPlanWidth);
  for (auto& line : m_lines) line = addLines(content, kPlanWidth);
  if (!vehicle.empty()) open(vehicle);
  readOrder();
  viewer.window().marks()->insert(m_marks);
  viewer.onActivated([this] { forget(); });
  viewer.onFrame([this] {
    if (!m_change) return;
    std::exchange(m_change, nullptr)(m_ranks);
    m_order.reset();
    listClasses();
    notes() << "order:";
    for (const auto& rank : m_ranks)
      notes() << (&rank == &m_ranks[0] ? " " : " > ") << nameOf(rank);
    notes() << std::endl;
    planAnew();
  });
}

void PlanPanel::say(const std::string& first, const std::string& second) {
  m_lines[0]->setCaption(first);
  m_lines[1]->setCaption(second);
  if (!first.empty()) notes() << first << ' ' << second << std::endl;
  m_viewer.window().redraw();
}

void PlanPanel::forget() {
  m_start.reset(), m_goal.reset();
  m_marks->clear();
  say("");
  readOrder();
}

std::string PlanPanel::open(const std::filesystem::path& file) {
  if (strict_files::readText(file).find("best_to_worst") == std::string::npos) {
    m_vehicle = semantic_planning::loadVehicle(file);
    m_vehicleName->setCaption("vehicle: " + file.filename().string());
    planAnew();
    return "the vehicle";
  }
  semantic_planning::loadClassOrder(file, m_viewer.layer().map().classes());
  m_orderFile = file;
  readOrder();
  return "an order of classes";
}

void PlanPanel::readOrder() {
  const auto& classes = m_viewer.layer().map().classes();
  m_ranks.clear();
  m_order.reset();
  try {
    if (!m_orderFile.empty())
      m_order.emplace(semantic_planning::loadClassOrder(m_orderFile, classes));
  } catch (const std::exception& e) {
    say("no paths here:", e.what());  // another map has other classes
  }
  if (m_order) m_ranks.resize(std::size_t(m_order->ranks()));
  for (int id = 0; m_order && id < m_order->classes(); ++id) {
    const auto graphClass = static_cast<colored_graph::GraphClass>(id);
    if (const auto rank = m_order->rank(graphClass); rank != colored_graph::kForbidden)
      m_ranks[std::size_t(rank)].push_back(graphClass);
  }
  listClasses();
  planAnew();
}

void PlanPanel::listClasses() {
  removeChildren(m_list);
  const auto& leaves = m_viewer.layer().leavesOfClass();
  std::vector<bool> isAllowed(leaves.size());
  for (std::size_t rank = 0; rank < m_ranks.size(); ++rank) {
    addLine(nameOf(m_ranks[rank]), true, rank, {});
    for (const auto id : m_ranks[rank]) isAllowed[id] = true;
  }
  for (std::size_t id = 0; id < leaves.size(); ++id)
    if (!isAllowed[id] && (leaves[id] > 0 || id == semantic_types::kNoClass))
      addLine(nameOf(colored_graph::GraphClass(id)), false, m_ranks.size(),
              colored_graph::GraphClass(id));
}

void PlanPanel::addLine(const std::string& name, bool isAllowed, std::size_t rank,
                        colored_graph::GraphClass id) {
  constexpr std::size_t kMostLetters = 32;
  auto* row = addRow(m_list);
  const auto allow = [this, rank, id](bool on) {
    change([=](Ranks& ranks) {
      if (on)
        ranks.push_back({id});
      else
        ranks.erase(ranks.begin() + std::ptrdiff_t(rank));
    });
  };
  addCheckBox(row, name.substr(0, kMostLetters), kPlanWidth - 50, isAllowed, allow);
  if (!isAllowed || rank == 0) return;
  auto* up = row->add<nanogui::ToolButton>(ENTYPO_ICON_ARROW_UP);
  up->setFlags(nanogui::Button::NormalButton);
  up->setFixedSize({22, 17});
  up->setTooltip("better");
  up->setCallback(
      [this, rank] { change([=](Ranks& ranks) { std::swap(ranks[rank - 1], ranks[rank]); }); });
}

void PlanPanel::change(const std::function<void(Ranks&)>& f) {
  m_change = f;
  m_viewer.window().redraw();
}

std::string PlanPanel::nameOf(colored_graph::GraphClass id) const {
  if (id == semantic_types::kNoClass) return semantic_planning::kUnknownGround;
  return m_viewer.layer().map().classes().name(semantic_types::ClassId(id));
}

std::string PlanPanel::nameOf(const std::vector<colored_graph::GraphClass>& rank) const {
  std::string names;
  for (const auto id : rank) names += (names.empty() ? "" : ", ") + nameOf(id);
  return names;
}

/** With what has changed, if there is something to plan. */
void PlanPanel::planAnew() {
  m_planner.reset();
  m_map.reset();
  if (m_start && m_goal) plan();
  m_viewer.window().redraw();
}

void PlanPanel::await(Awaited what) {
  m_awaited = what;
  say(what == Awaited::Start ? "click where the vehicle is" : "click where it is to go",
      "and drag for its heading");
}

bool PlanPanel::place(const map_view::Ray& ray) {
  if (m_awaited == Awaited::Nothing) return false;
  const Layer& layer = m_viewer.layer();
  const auto cell = firstShown(layer.cells(), layer.look(), ray);
  if (!cell) {
    say("nothing there");
    return false;
  }
  // Where the ray meets the height of the cell's upper side, within the cell.
  const double voxel = layer.map().getResolution();
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = semantic_octree::lowerBorderOf(cell->lowest[axis], voxel);
    high[axis] = low[axis] + cell->edge() * voxel;
  }
  Eigen::Vector3d place = atHeight(ray, high.z()).cwiseMax(low).cwiseMin(high);
  place.z() = high.z();
  awaited() = Pose{place, {}};
  draw(nullptr);
  return true;
}

void PlanPanel::turn(const map_view::Ray& ray, bool letsGo) {
  Pose& pose = *awaited();
  const Eigen::Vector3d way = atHeight(ray, pose.place.z()) - pose.place;
  pose.heading.reset();
  if (way.norm() > kTurn) pose.heading = std::atan2(way.y(), way.x());
  draw(nullptr);
  if (!letsGo) return;
  const std::string what = m_awaited == Awaited::Start ? "start" : "goal";
  const auto& p = pose.place;
  const std::string text = what + mrpt::format(" at %.1f %.1f %.1f m", p.x(), p.y(), p.z());
  std::string heading;
  if (pose.heading) heading = mrpt::format("heading %.0f deg", *pose.heading * 180 / M_PI);
  m_awaited = Awaited::Nothing;
  say(text, heading);
  if (m_start && m_goal) plan();
}

void PlanPanel::begin() {
  m_map = std::make_unique<semantic_octree::SemanticOcTree>(m_viewer.layer().map());
  if (!m_order) m_order.emplace(m_map->numClasses() + 1, m_ranks);
  setAbstraction(*m_map, semantic_planning::abstractionFor(*m_order));
  semantic_planning::PlannerOptions options;
  options.shorten = true;
  options.vehicle = m_vehicle;
  m_planner.emplace(*m_map, *m_order, options);
}

void PlanPanel::plan() {
  try {
    const measuring::Stopwatch watch;
    if (m_ranks.empty()) return say("no path:", "no class is allowed: check some below");
    if (!m_planner) begin();
    const Eigen::Vector3d way = m_goal->place - m_start->place;
    const auto poseOf = [&](const Pose& p) {
      return TPose2D(p.place.x(), p.place.y(), p.heading.value_or(std::atan2(way.y(), way.x())));
    };
    const PlanResult plan =
        m_planner->plan(poseOf(*m_start), poseOf(*m_goal), m_start->place.z(), m_goal->place.z());
    draw(&plan);
    if (!plan.found()) return say("no path:", plan.reason);
    say(mrpt::format("path of %.1f m, in %.1f s", plan.length, watch.milliseconds() / 1000));
  } catch (const std::exception& e) {
    say("no path:", e.what());
  }
}

void PlanPanel::draw(const PlanResult* plan) {
  const float width = bandWidth(m_viewer.window());
  m_marks->clear();
  const auto mark = [&](const std::optional<Pose>& pose, const mrpt::img::TColor& color) {
    if (!pose) return;
    m_marks->insert(postAt(pose->place, color, width));
    if (pose->heading) m_marks->insert(arrowAt(pose->place, *pose->heading, color, width));
  };
  mark(m_start, kStartColor);
  mark(m_goal, kGoalColor);
  if (plan && plan->found()) m_marks->insert(bandAlong(pointsOf(*plan), width));
}

}  // namespace semantic_map_view
