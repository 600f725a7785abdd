#include <ompl/base/samplers/deterministic/HaltonSequence.h>

#include <cmath>

#include "Candidates.h"

namespace semantic_planning {
namespace {

/** Another sequence of the same evenness for every seed (Cranley, Patterson 1976). */
std::vector<double> rotated(std::vector<double> draw, unsigned seed) {
  double shift = 0.618033988749895 * seed;
  for (double& x : draw) {
    x += shift;
    x -= std::floor(x);
    shift *= 1.324717957244746;
  }
  return draw;
}

/** Drops the draws that the weights of the ranks leave out. */
bool keepsByClass(const Ground& ground, const Candidate& c, const colored_graph::ClassOrder& order,
                  double draw) {
  const Surface* s = ground.near(ground.columnAt(c.pose.pose.x, c.pose.pose.y), c.pose.z, 0);
  const colored_graph::Rank rank = s ? order.rank(s->classId) : colored_graph::kForbidden;
  return rank != colored_graph::kForbidden && draw < std::ldexp(1.0, -rank);
}

std::optional<Candidate> candidateAt(const CandidateSearch& search,
                                     const std::vector<double>& draw) {
  const mrpt::math::TPoint2D p = search.region.at(draw[0], draw[1]);
  const auto point = search.ground.find(p.x, p.y);
  if (!point) return std::nullopt;
  Candidate c;
  c.pose = {{p.x, p.y, std::remainder(2 * M_PI * draw[2], 2 * M_PI)}, point->surface.z};
  return c;
}

}  // namespace

void drawHalton(const CandidateSearch& search, const colored_graph::ClassOrder& order,
                const std::function<bool(const std::optional<Candidate>&)>& enough) {
  ompl::base::HaltonSequence sequence(4);
  const std::size_t most = 1000 * search.options.vertices;
  for (std::size_t i = 0; i < most; ++i) {
    const std::vector<double> draw = rotated(sequence.sample(), search.options.seed);
    auto candidate = candidateAt(search, draw);
    const bool byClass = search.options.kind == GraphKind::HaltonByClass;
    if (candidate && byClass && !keepsByClass(search.ground, *candidate, order, draw[3]))
      candidate.reset();
    if (enough(candidate)) return;
  }
}

}  // namespace semantic_planning
