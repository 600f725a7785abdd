#pragma once
#include <mrpt/math/TPose2D.h>
#include <semantic_planning/planner/SemanticPlanner.h>
#include <strict_files/OptionList.h>
#include <view_information/GainField.h>

#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace semantic_driving {

/** A pose from which to see more. */
struct View {
  mrpt::math::TPose2D pose;  ///< map frame
  double z = 0;              ///< height of the ground, meters
  double way = 0;            ///< meters there, where it costs least by the order of classes
  double promise = 0;        ///< nats that it is expected to tell; of frontiers: 0
};

/** What a robot explores with. */
struct ExploreOptions {
  view_information::ViewShape sensor;
  double sensorHeight = 1.2;                                ///< above the ground, meters
  double budget = std::numeric_limits<double>::infinity();  ///< meters that it drives at most
  /** Where views may be, map frame, meters; empty: everywhere. */
  Eigen::AlignedBox2d area;
  /** Exploring ends when what is left within reach is expected to tell less than this share of all
   * that is known and left. */
  double leftShare = 0.03;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the option and its value. */
  void validate() const;
};

/** Chooses where to look next, without a goal.
 *
 *     while (const auto view = strategy->next(pose, z)) {
 *       driveTo(*view);               // or a part of the way
 *       if (arrived() || noWay()) strategy->done(*view);
 *     }
 *
 * The planner has to be up to date in each call. Choices follow from the calls alone. */
class ViewStrategy {
 public:
  virtual ~ViewStrategy() = default;
  /** \param from where the vehicle is, on ground of height z (meters) \return nothing: it is over,
   * see conclusion() */
  virtual std::optional<View> next(const mrpt::math::TPose2D& from, double z) = 0;
  /** The vehicle looked from there, or cannot get there: neither this view nor one like it is
   * chosen again. */
  virtual void done(const View& view) = 0;
  /** A sentence for people, when it is over. */
  virtual std::string conclusion() const = 0;
  /** What the most promising look of the last call of next() adds to a compressed tree's objective
   * (GainField::growth()), nats summed over voxels; 0 unless it is predicted. The map has to be as
   * it was. */
  virtual view_information::Bounds growth() const { return {}; }
  /** What a look from a pose on ground of height z may tell by the last next()'s map, nats; 0
   * unless it is predicted. */
  virtual double promise(const mrpt::math::TPose2D&, double) { return 0; }
  /** What looking at a column of the map (keys) may still tell, nats; 0 unless it is
   * predicted. */
  virtual double left(semantic_planning::Column) { return 0; }
};

/** The nearest border of what is known, as Yamauchi, "A frontier-based approach for autonomous
 * exploration", 1997. \param planner must outlive it */
std::unique_ptr<ViewStrategy> nearestFrontier(const semantic_planning::SemanticPlanner& planner,
                                              const ExploreOptions& options);

/** The views that tell most about what weights ask for, for each meter of the way. They make a tour
 * over the places where much is left, and leave nothing behind that is dear to come back to.
 * \param map the planner's; both must outlive it \param learned whether unknown space is predicted
 * from what is known; without, weights bring nothing */
std::unique_ptr<ViewStrategy> relevantViews(const semantic_planning::SemanticPlanner& planner,
                                            semantic_octree::SemanticOcTree& map,
                                            const tree_abstraction::AbstractionWeights& weights,
                                            const ExploreOptions& options, bool learned = true);

}  // namespace semantic_driving
