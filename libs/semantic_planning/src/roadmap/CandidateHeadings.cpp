#include <cmath>
#include <complex>

#include "Candidates.h"
#include "UnitHash.h"

namespace semantic_planning {
namespace {

constexpr int kRays = 16, kStep = 2;  // columns between places of a ray that are looked at

/** How far it goes on from a point over ground that is no worse than there, meters. */
double freeLength(const CandidatePoint& point, double direction, colored_graph::Rank rank,
                  const CollisionChecker& checker) {
  const Ground& ground = checker.ground();
  const int steps = static_cast<int>(kHeadingReach / (kStep * ground.voxelSize()));
  const double cosine = std::cos(direction), sine = std::sin(direction);
  int z = point.z;
  for (int i = 1; i <= steps; ++i) {
    const auto along = [&](double share) {
      return static_cast<int>(std::lround(i * kStep * share));
    };
    const Surface* s = ground.near({point.column.x + along(cosine), point.column.y + along(sine)},
                                   z, kStep * ground.step());
    if (!s || !s->drivable || s->clearance2 == 0 || checker.order().rank(s->classId) > rank)
      return (i - 1) * kStep * ground.voxelSize();
    z = s->z;
  }
  return kHeadingReach;
}

/** The axis of the free space around a point: that of the rays' second moments; or nothing if they
 * are much the same. */
std::optional<double> axisAt(const CandidatePoint& point, const CollisionChecker& checker) {
  const Surface* s = checker.ground().near(point.column, point.z, 0);
  const colored_graph::Rank rank = s ? checker.order().rank(s->classId) : 0;
  std::complex<double> moments;
  double sum = 0;
  for (int i = 0; i < kRays; ++i) {
    const double direction = 2 * M_PI * i / kRays,
                 length = freeLength(point, direction, rank, checker);
    moments += std::polar(length * length, 2 * direction);  // opposite rays count for one axis
    sum += length * length;
  }
  constexpr double kLeastShare = 0.1;
  if (std::abs(moments) <= kLeastShare * sum) return std::nullopt;
  return std::arg(moments) / 2;
}

}  // namespace

std::vector<GroundPose> candidatesAt(const CandidatePoint& point, const CollisionChecker& checker,
                                     const RoadmapOptions& options) {
  const double random = unitHash(static_cast<std::uint32_t>(point.column.x),
                                 static_cast<std::uint32_t>(point.column.y), options.seed);
  const bool aligned = hasAlignedHeadings(options.kind);
  const int headings = aligned ? 2 : 1;
  double first = 2 * M_PI * random / headings;
  if (const auto axis = aligned ? axisAt(point, checker) : std::nullopt)
    first = *axis + (random < 0.5 ? 0 : M_PI);
  const Ground& ground = checker.ground();
  const double x = ground.centerOf(point.column.x), y = ground.centerOf(point.column.y);
  std::vector<GroundPose> candidates;
  for (int i = 0; i < headings; ++i) {
    const double heading = std::remainder(first + 2 * M_PI * i / headings, 2 * M_PI);
    candidates.push_back({{x, y, heading}, point.z});
  }
  return candidates;
}

}  // namespace semantic_planning
