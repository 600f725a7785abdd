#include <view_information/UnknownPrior.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace view_information {

namespace {

constexpr double kReach = 10;     // m: how far known ground says something about unknown ground
constexpr double kHighest = 2.6;  // m above the ground: up to there something may stand
constexpr double kGroundIsThere = 0.9;
constexpr double kMeanArea = 0.02;  // m^2 of known ground that count as much as the mean of all

/** What ground at a distance (m) says: lawns and streets go on for a while, and some for long. */
double weightAt(double distance) {
  return std::exp(-distance * distance / 4.5) + 0.05 * std::exp(-distance / 4);
}

}  // namespace

double passThrough(double occupied, double floor) {
  constexpr double kStops = 0.95;
  return 1 - kStops * std::max(0.0, (occupied - floor) / (1 - floor));
}

std::vector<double> nothingKnown(int numClasses) {
  std::vector<double> p(static_cast<std::size_t>(numClasses) + 1, 0.5 / numClasses);
  p[0] = 0.5;
  return p;
}

UniformPrior::UniformPrior(const Question& question, const BeamModel& model) {
  const std::vector<double> p = nothingKnown(question.numClasses());
  const double gain = std::max(0.0, question.information(model, p.data()));
  m_patch.ground = std::numeric_limits<int>::min() / 2;
  m_patch.top = std::numeric_limits<int>::max();
  m_patch.above = {static_cast<float>(passThrough(0.5, 0)), static_cast<float>(gain)};
}

LearnedPrior::LearnedPrior(const semantic_octree::SemanticOcTree& map, const Question& question)
    : m_map(map),
      m_question(question),
      m_model(map.numClasses(), map.filterParameters()),
      m_columnArea(map.getResolution() * map.getResolution()) {
  const double edge = UnknownPatch::kEdge * map.getResolution();
  m_reach = static_cast<int>(std::ceil(kReach / edge));
  for (int d2 = 0; d2 <= 2 * m_reach * m_reach; ++d2)
    m_kernel.push_back(weightAt(std::sqrt(d2) * edge));
  const auto classes = static_cast<std::size_t>(map.numClasses()) + 1;
  m_worthOfGround = worthOf(nothingKnown(map.numClasses()));
  m_standsOn.assign(classes, Distribution(classes, 0));
  spread();
}

void LearnedPrior::learn(int x, int y, int z, ClassId ground) {
  constexpr int kEdge = UnknownPatch::kEdge;
  const int px = x / kEdge, py = y / kEdge, column = x % kEdge * kEdge + y % kEdge;
  Patch& patch = at(px, py);
  Ground& known = patch.columns[static_cast<std::size_t>(column)];
  const Ground now{ground, static_cast<std::uint16_t>(z)};
  if (known.z == now.z && known.id == now.id) return;
  if (known.z == 0) learnAbove(x, y, z, ground), m_usualHeight = z;
  known = now;
  patch.prior.grounded |= static_cast<std::uint16_t>(1 << column);
  if (!std::exchange(patch.hasChanged, true)) m_changed.push_back({px, py});
}

LearnedPrior::Patch& LearnedPrior::at(int x, int y) {
  std::unique_ptr<Block>& block = m_blocks[keyOf(x / kBlock, y / kBlock)];
  if (!block) block = std::make_unique<Block>();
  return (*block)[static_cast<std::size_t>(x % kBlock * kBlock + y % kBlock)];
}

/** f(patch, squared distance in patches) within reach. */
template <class F>
void LearnedPrior::forNear(int x, int y, F f) const {
  const int low = y - m_reach, high = y + m_reach;
  for (int bx = (x - m_reach) / kBlock; bx <= (x + m_reach) / kBlock; ++bx)
    for (int by = low / kBlock; by <= high / kBlock; ++by) {
      const auto block = m_blocks.find(keyOf(bx, by));
      if (block == m_blocks.end()) continue;
      const int fromX = std::max(x - m_reach, bx * kBlock), fromY = std::max(low, by * kBlock);
      const int toX = std::min(x + m_reach, bx * kBlock + kBlock - 1);
      const int toY = std::min(high, by * kBlock + kBlock - 1);
      for (int i = fromX; i <= toX; ++i)
        for (int j = fromY; j <= toY; ++j)
          f((*block->second)[static_cast<std::size_t>(i % kBlock * kBlock + j % kBlock)],
            static_cast<std::size_t>((i - x) * (i - x) + (j - y) * (j - y)));
    }
}

void LearnedPrior::count(Patch& patch) {
  patch.hasChanged = false;
  patch.known = 0, patch.heights = 0;
  patch.classes.clear();
  for (const Ground& g : patch.columns) {
    if (g.z == 0) continue;
    ++patch.known, patch.heights += g.z;
    if (g.id == semantic_octree::kNoClass) continue;
    const auto isIt = [&](const auto& one) { return one.first == g.id; };
    const auto found = std::find_if(patch.classes.begin(), patch.classes.end(), isIt);
    if (found == patch.classes.end())
      patch.classes.emplace_back(g.id, 1);
    else
      ++found->second;
  }
}

/** All around what changed is to be predicted anew. */
void LearnedPrior::spread() {
  for (const auto& [x, y] : m_changed) {
    count(at(x, y));
    forNear(x, y, [](Patch& patch, std::size_t) { patch.isStale = true; });
  }
  m_changed.clear();
  m_worthAbove = worthOf(above(ground({Distribution(m_standsOn.size(), 0)})));
}

/** Some heights of the column, as far as they are known. */
void LearnedPrior::learnAbove(int x, int y, int z, ClassId ground) {
  constexpr double kFrom = 0.4, kStep = 0.6, kTo = 2.4;  // m
  for (double up = kFrom; up < kTo + kStep / 2; up += kStep) {
    const int key = z + static_cast<int>(std::lround(up / m_map.getResolution()));
    const auto node = m_map.search(semantic_octree::octomapKey(x, y, key));
    if (!node) continue;
    const bool isThing = m_map.isNodeOccupied(node) && node.hasClassRecord();
    m_standsOn[ground][isThing ? m_map.belief(node).ids[0] : 0] += 1;
  }
}

const UnknownPatch& LearnedPrior::patch(int x, int y) {
  if (!m_changed.empty()) spread();
  Patch& patch = at(x, y);
  if (patch.isStale) predict(x, y, patch);
  patch.isStale = false;
  return patch.prior;
}

UnknownPatch LearnedPrior::lookAt(int x, int y) const {
  const auto block = m_blocks.find(keyOf(x / kBlock, y / kBlock));
  const auto at = static_cast<std::size_t>(x % kBlock * kBlock + y % kBlock);
  Patch patch = block == m_blocks.end() ? Patch() : (*block->second)[at];
  if (patch.isStale) predict(x, y, patch);
  return patch.prior;
}

LearnedPrior::Near LearnedPrior::near(int x, int y) const {
  Near near{Distribution(m_standsOn.size(), 0)};
  forNear(x, y, [&](const Patch& patch, std::size_t distance2) {
    if (patch.known == 0) return;
    const double weight = m_columnArea * m_kernel[distance2];
    near.height += weight * patch.heights, near.heights += weight * patch.known;
    for (const auto& [id, columns] : patch.classes)
      near.ground[id] += weight * columns, near.classes += weight * columns;
  });
  return near;
}

/** Classes of the ground, where there is some. */
LearnedPrior::Distribution LearnedPrior::ground(const Near& near) const {
  Distribution p(m_standsOn.size(), 0);
  double all = 0;
  for (std::size_t k = 1; k < p.size(); ++k) all += m_standsOn[k][0] + 1;
  for (std::size_t k = 1; k < p.size(); ++k)
    p[k] = kGroundIsThere * (near.ground[k] + kMeanArea * (m_standsOn[k][0] + 1) / all) /
           (near.classes + kMeanArea);
  p[0] = 1 - kGroundIsThere;
  return p;
}

/** What a voxel above it is: each class of ground has its own things. */
LearnedPrior::Distribution LearnedPrior::above(const Distribution& ground) const {
  constexpr double kNotSeenYet = 4, kThings = 0.1;  // looks, and the share of things in these
  const auto K = static_cast<double>(ground.size() - 1);
  Distribution p(ground.size(), 0);
  for (std::size_t g = 1; g < ground.size(); ++g) {
    double seen = kNotSeenYet;
    for (const double count : m_standsOn[g]) seen += count;
    for (std::size_t k = 1; k < p.size(); ++k)
      p[k] += ground[g] / kGroundIsThere * (m_standsOn[g][k] + kNotSeenYet * kThings / K) / seen;
  }
  p[0] = 1;
  for (std::size_t k = 1; k < p.size(); ++k) p[0] -= p[k];
  return p;
}

/** What each outcome is worth to who believed something before. */
LearnedPrior::Distribution LearnedPrior::worthOf(const Distribution& before) const {
  Distribution worth;
  for (int w = 0; w <= m_question.numClasses(); ++w)
    worth.push_back(m_question.surprise(m_model, before.data(), w));
  return worth;
}

Gain LearnedPrior::gainOf(const Distribution& p, const Distribution& worth) const {
  double gain = 0;
  for (std::size_t w = 0; w < p.size(); ++w)
    gain += m_model.probability(static_cast<int>(w), p.data()) * worth[w];
  return {static_cast<float>(passThrough(1 - p[0], 0)), static_cast<float>(std::max(0.0, gain))};
}

void LearnedPrior::predict(int x, int y, Patch& patch) const {
  const Near around = near(x, y);
  const Distribution g = ground(around);
  UnknownPatch& prior = patch.prior;
  prior.ground = around.heights > 0 ? static_cast<int>(std::lround(around.height / around.heights))
                                    : m_usualHeight;
  prior.top = prior.ground + static_cast<int>(kHighest / m_map.getResolution());
  prior.onGround = gainOf(g, m_worthOfGround);
  prior.above = gainOf(above(g), m_worthAbove);
}

std::size_t LearnedPrior::memoryUsage() const {
  constexpr std::size_t kOfEntry = 6 * sizeof(void*);  // of the table, and of the heap
  return m_blocks.size() * (sizeof(Block) + kOfEntry);
}

}  // namespace view_information
