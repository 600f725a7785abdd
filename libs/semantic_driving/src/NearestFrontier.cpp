#include <semantic_driving/Explorer.h>

#include "ViewPlaces.h"

namespace semantic_driving {

using mrpt::math::TPose2D;
using semantic_planning::Ground;
using semantic_planning::SemanticPlanner;

namespace {

class NearestFrontier : public ViewStrategy {
 public:
  NearestFrontier(const SemanticPlanner& planner, const ExploreOptions& options)
      : m_planner(planner), m_options(options) {
    m_options.validate();
  }

  std::optional<View> next(const TPose2D& from, double z) override {
    const Ground& ground = m_planner.ground();
    const GroundFlood flood(m_planner, from, ground.keyOf(z), kFrontierRadius);
    std::optional<View> nearest;
    for (const ViewPlace& place : placesOf(flood, ground, m_options.area)) {
      if (nearest && place.length >= nearest->way) break;
      const auto heading = headingToUnknown(ground, place);
      if (!heading || place.length < kSeenFromHere) continue;
      const TPose2D pose{ground.centerOf(place.column.x), ground.centerOf(place.column.y),
                         *heading};
      const double way =
          wayTo(place, from.phi, *heading, m_planner.options().vehicle.turningRadius);
      const double height = ground.centerOf(place.z);
      if ((!nearest || way < nearest->way) && !m_done.has(pose, 2 * M_PI) &&
          m_planner.check(pose, height) == semantic_planning::PlanStatus::Found)
        nearest = View{pose, height, way, 0};
    }
    return nearest;
  }
  void done(const View& view) override { m_done.add(view.pose); }
  std::string conclusion() const override {
    return "no border of what is known is left within reach; places looked from: " +
           std::to_string(m_done.size());
  }

 private:
  static constexpr double kSeenFromHere = 0.8;  // m

  const SemanticPlanner& m_planner;
  const ExploreOptions m_options;
  DoneViews m_done;
};

}  // namespace

std::unique_ptr<ViewStrategy> nearestFrontier(const SemanticPlanner& planner,
                                              const ExploreOptions& options) {
  return std::make_unique<NearestFrontier>(planner, options);
}

}  // namespace semantic_driving
