#include "PlanPanel.h"

#include <map_view/OrbitCamera.h>
#include <mrpt/core/format.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_planning/planner/OrderFile.h>

#include <cmath>
#include <ostream>

#include "StandardOutput.h"
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

constexpr int kPlanWidth = 230, kOrderWidth = 160;
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
                     semantic_planning::VehicleOptions vehicle)
    : m_viewer(viewer),
      m_orderFile(std::move(orderFile)),
      m_vehicle(std::move(vehicle)),
      m_window(addWindow(&viewer.window(), "Path", {8, viewer.window().height() - 120},
                         kPlanWidth + 16)) {
  if (!m_orderFile.empty()) {
    auto* row = addRow(m_window);
    m_startButton = row->add<nanogui::Button>("start");
    m_goalButton = row->add<nanogui::Button>("goal");
    for (auto* button : {m_startButton, m_goalButton}) button->setFixedSize({90, 22});
    m_startButton->setCallback([this] { await(Awaited::Start); });
    m_goalButton->setCallback([this] { await(Awaited::Goal); });
    auto* order = addWindow(&viewer.window(), "Best class first: drag", {262, 8}, kOrderWidth + 16);
    m_order = order->add<OrderList>([this](const auto& ranks) { reorder(ranks); });
    readOrder();
    m_order->setFixedSize({kOrderWidth, m_order->preferredSize(nullptr).y()});
  }
  for (auto& line : m_lines) line = addText(m_window, "", kPlanWidth);
  m_lines[1]->setFixedHeight(0);  // as many lines as it takes
  if (m_orderFile.empty()) m_lines[0]->setCaption("needs --order");
  viewer.window().marks()->insert(m_marks);
  viewer.onActivated([this] { forget(); });
}

void PlanPanel::say(const std::string& first, const std::string& second) {
  m_lines[0]->setCaption(first);
  m_lines[1]->setCaption(second);
  if (!first.empty()) notes() << first << ' ' << second << std::endl;
  m_viewer.window().performLayout();
  // What grows has to end above the lower border.
  m_window->setPosition({8, std::min(m_viewer.window().height() - 120,
                                     m_viewer.window().height() - m_window->height() - 8)});
  m_viewer.window().redraw();
}

void PlanPanel::forget() {
  m_planner.reset();
  m_map.reset();
  m_start.reset(), m_goal.reset();
  m_marks->clear();
  say("");
  if (m_order) readOrder();
}

void PlanPanel::readOrder() {
  const auto& classes = m_viewer.layer().map().classes();
  m_ranks.clear();
  try {
    const auto order = semantic_planning::loadClassOrder(m_orderFile, classes);
    m_numClasses = order.classes();
    m_ranks.resize(std::size_t(order.ranks()));
    for (int id = 0; id < m_numClasses; ++id) {
      const auto graphClass = static_cast<colored_graph::GraphClass>(id);
      if (const auto rank = order.rank(graphClass); rank != colored_graph::kForbidden)
        m_ranks[std::size_t(rank)].push_back(graphClass);
    }
  } catch (const std::exception& e) {
    say("no paths here:", e.what());  // another map has other classes
  }
  m_order->setNames(rankNames());
}

std::vector<std::string> PlanPanel::rankNames() const {
  std::vector<std::string> names;
  for (const auto& rank : m_ranks) {
    names.emplace_back();
    for (const auto id : rank) {
      if (!names.back().empty()) names.back() += ", ";
      names.back() += id == semantic_types::kNoClass
                          ? semantic_planning::kUnknownGround
                          : m_viewer.layer().map().classes().name(semantic_types::ClassId(id));
    }
  }
  return names;
}

void PlanPanel::reorder(const std::vector<std::size_t>& ranks) {
  const auto before = m_ranks;
  for (std::size_t i = 0; i < ranks.size(); ++i) m_ranks[i] = before[ranks[i]];
  const std::vector<std::string> names = rankNames();
  m_order->setNames(names);
  std::string text = "order: " + names.front();
  for (std::size_t i = 1; i < names.size(); ++i) text += " > " + names[i];
  notes() << text << std::endl;
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
  const colored_graph::ClassOrder order(m_numClasses, m_ranks);
  setAbstraction(*m_map, semantic_planning::abstractionFor(order));
  semantic_planning::PlannerOptions options;
  options.shorten = true;
  options.vehicle = m_vehicle;
  m_planner.emplace(*m_map, order, options);
}

void PlanPanel::plan() {
  try {
    const measuring::Stopwatch watch;
    if (!m_planner) begin();
    const Eigen::Vector3d way = m_goal->place - m_start->place;
    const auto poseOf = [&](const Pose& p) {
      return TPose2D(p.place.x(), p.place.y(), p.heading.value_or(std::atan2(way.y(), way.x())));
    };
    const PlanResult plan =
        m_planner->plan(poseOf(*m_start), poseOf(*m_goal), m_start->place.z(), m_goal->place.z());
    draw(&plan);
    if (!plan.found()) return say("no path:", plan.reason);
    say(mrpt::format("path of %.1f m, in %.0f ms", plan.length, watch.milliseconds()));
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
