#pragma once
#include <colored_graph/ClassOrder.h>
#include <colored_graph/ColoredGraph.h>
#include <semantic_planning/ground/Ground.h>
#include <semantic_planning/roadmap/RoadmapOptions.h>
#include <semantic_planning/vehicle/MotionCost.h>
#include <semantic_planning/vehicle/PathPoint.h>
#include <semantic_planning/vehicle/ReedsShepp.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace semantic_planning {

struct Placement;
class OpenGround;

/** A pose on the ground. */
struct GroundPose {
  mrpt::math::TPose2D pose;  ///< meters, radians; map frame
  int z = 0;                 ///< key of the surface below the origin
};

/** How a vehicle fits onto the ground. */
enum class Fit {
  Free,
  OffGround,  ///< no drivable ground below the origin
  Blocked     ///< the footprint does not fit
};

/** What a way may cost for its classes: looking at it ends where it costs more. */
struct ClassBudget {
  std::vector<double> prices;  ///< of a meter, by class
  double left = 0;
  bool isSpent() const { return left < 0; }
};

/** Where a vehicle fits, and over which classes it goes. The footprint is checked as discs, which
 * keep their distance from whole voxels: this errs to the safe side by about a voxel. Several
 * threads may ask at a time. */
class CollisionChecker {
 public:
  /** A disc of the footprint, and what it asks of the surface below its center. */
  struct CheckedDisc {
    Disc disc;
    int needed2;    ///< Surface::clearance2
    int tolerance;  ///< voxels in height against the origin
  };

  /** \param ground must outlive the checker. \throw std::invalid_argument bad options. */
  CollisionChecker(const Ground& ground, const VehicleOptions& vehicle,
                   const colored_graph::ClassOrder& order);

  /** One for a search: the same answers, sooner, for it keeps what it finds out about the ground.
   * For one thread, and as long as the ground stays as it is. */
  CollisionChecker forSearch() const;

  const Ground& ground() const { return m_ground; }
  const ReedsShepp& reedsShepp() const { return m_reedsShepp; }
  const MotionCost& motionCost() const { return m_motionCost; }
  const colored_graph::ClassOrder& order() const { return m_order; }
  const std::vector<CheckedDisc>& discs() const { return m_discs; }
  /** Where wheel tracks run: y in the vehicle's frame, meters. */
  const std::vector<double>& wheels() const { return m_wheels; }

  /** Puts a pose onto the surface nearest to a height (see Ground::find()). */
  std::optional<GroundPose> place(const mrpt::math::TPose2D& pose,
                                  std::optional<double> nearZ = {}) const;
  Fit fit(const GroundPose& pose) const;
  /** The worst class under the wheels. */
  ClassId classAt(const GroundPose& pose) const;

  /** The classes along a curve, or nothing if it is blocked or does not lead to b's level. Looked
   * at every half voxel or closer; the lengths add up to the curve's, rounded up. The footprint
   * keeps its clearance at all places of the curve, also between those, if it does where that
   * begins (fit()). \param from, to keys of the surfaces at its ends \param budget if it is spent
   * there is no answer, either */
  std::optional<colored_graph::EdgeProfile> profile(const ReedsSheppCurve& curve, int from, int to,
                                                    ClassBudget* budget = nullptr) const;
  /** The profile of the vehicle's shortest curve from a to b. */
  std::optional<colored_graph::EdgeProfile> profile(const GroundPose& a, const GroundPose& b) const;

  /** Points along a free curve at most half a voxel apart, from its start to its end, and wherever
   * steering or gear change. \param z of the ground at the start */
  std::vector<PathPoint> trace(const ReedsSheppCurve& curve, int z) const;

  /** Columns that a curve's outcome may depend on lie within this distance of it, meters. */
  double reach() const { return m_reach; }

 private:
  using Lengths = std::array<double, 256>;  ///< meters by class

  const Surface* near(Column c, int z, int tolerance) const;
  class Sweep;
  bool isFree(const CheckedDisc& disc, Column c, int z) const;
  /** Under each wheel track; there are one or two. */
  using WheelColumns = std::array<Column, 2>;
  WheelColumns wheelColumns(const Placement& placed) const;
  std::optional<ClassId> worstUnder(const WheelColumns& wheels, int z) const;

  const Ground& m_ground;
  const colored_graph::ClassOrder m_order;
  ReedsShepp m_reedsShepp;
  MotionCost m_motionCost;
  std::vector<CheckedDisc> m_discs;
  double m_piece;                ///< of curves, between places that are looked at; meters
  std::vector<double> m_wheels;  ///< y in the vehicle's frame
  int m_wheelTolerance;
  double m_reach;
  std::shared_ptr<OpenGround> m_open;  ///< of a search
};

}  // namespace semantic_planning
