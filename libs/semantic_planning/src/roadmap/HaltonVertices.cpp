#include <algorithm>
#include <cmath>

#include "Candidates.h"
#include "Halton.h"

namespace semantic_planning {
namespace {

/** For each vertex asked for: draws in the region, and draws outside of it. */
constexpr std::size_t kMostDraws = 1000, kMostSkips = 10000;

/** Another sequence of the same evenness for every seed (Cranley, Patterson 1976). */
std::array<double, 4> rotated(std::array<double, 4> draw, unsigned seed) {
  double shift = 0.618033988749895 * seed;
  for (double& x : draw) {
    x += shift;
    x -= std::floor(x);
    shift *= 1.324717957244746;
  }
  return draw;
}

/** The rectangle of the tiles that hold ground. */
class GroundRectangle {
 public:
  explicit GroundRectangle(const Ground& ground) : m_voxelSize(ground.voxelSize()) {
    const std::vector<Column> tiles = ground.tiles();
    const auto [left, right] = std::minmax_element(tiles.begin(), tiles.end());
    const auto [bottom, top] = std::minmax_element(
        tiles.begin(), tiles.end(), [](const Column& l, const Column& r) { return l.y < r.y; });
    const Column first = firstColumnOf({left->x, bottom->y});
    m_low = {lowest(ground, first.x), lowest(ground, first.y)};
    m_width = (right->x - left->x + 1) * kTileEdge * m_voxelSize;
    m_height = (top->y - bottom->y + 1) * kTileEdge * m_voxelSize;
  }

  mrpt::math::TPoint2D at(double u, double v) const {
    return {m_low.x + u * m_width, m_low.y + v * m_height};
  }

 private:
  double lowest(const Ground& ground, int key) const {
    return ground.centerOf(key) - m_voxelSize / 2;
  }

  double m_voxelSize;
  mrpt::math::TPoint2D m_low;
  double m_width, m_height;
};

std::optional<GroundPose> candidateAt(const Ground& ground, const mrpt::math::TPoint2D& p,
                                      double turn) {
  const auto point = ground.find(p.x, p.y);
  if (!point) return std::nullopt;
  return GroundPose{{p.x, p.y, std::remainder(2 * M_PI * turn, 2 * M_PI)}, point->surface.z};
}

}  // namespace

void drawHalton(const HaltonSearch& search,
                const std::function<bool(const std::optional<GroundPose>&)>& enough) {
  const bool overMap = !search.region.hasRectangle();
  std::optional<GroundRectangle> rectangle;
  if (overMap) rectangle.emplace(search.ground);
  unsigned point = 0;
  std::size_t left = kMostDraws * search.options.vertices;
  for (std::size_t skips = kMostSkips * search.options.vertices; left > 0 && skips > 0;) {
    const auto draw = rotated(haltonPoint(++point), search.options.seed);
    const auto p = (overMap ? rectangle->at(draw[0], draw[1]) : search.region.at(draw[0], draw[1]));
    if (overMap && !search.region.contains(p.x, p.y)) {
      --skips;
      continue;
    }
    --left;
    if (enough(candidateAt(search.ground, p, draw[2]))) return;
  }
}

}  // namespace semantic_planning
