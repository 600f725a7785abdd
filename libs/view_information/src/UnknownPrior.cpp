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
  Patch& patch = blockOf(px, py).patches[numberOf(px, py)];
  Ground& known = patch.columns[static_cast<std::size_t>(column)];
  const Ground now{ground, static_cast<std::uint16_t>(z)};
  if (known.z == now.z && known.id == now.id) return;
  if (known.z == 0) learnAbove(x, y, z, ground), m_usualHeight = z;
  known = now;
  patch.prior.grounded |= static_cast<std::uint16_t>(1 << column);
  if (!std::exchange(patch.hasChanged, true)) m_changed.push_back({px, py});
}

LearnedPrior::Block& LearnedPrior::blockOf(int x, int y) {
  std::unique_ptr<Block>& block = m_blocks[keyOf(x / kBlock, y / kBlock)];
  if (!block) block = std::make_unique<Block>();
  return *block;
}

/** f(block, one bit for each of its patches within reach, where its first one is from x, y). */
template <class F>
void LearnedPrior::forNear(int x, int y, F f) const {
  constexpr std::uint64_t kEachRow = 0x0101010101010101U;
  constexpr int kLast = kBlock - 1;
  for (int bx = (x - m_reach) / kBlock; bx <= (x + m_reach) / kBlock; ++bx)
    for (int by = (y - m_reach) / kBlock; by <= (y + m_reach) / kBlock; ++by) {
      const auto block = m_blocks.find(keyOf(bx, by));
      if (block == m_blocks.end()) continue;
      const int dx = bx * kBlock - x, dy = by * kBlock - y;
      const int fromX = std::max(0, -m_reach - dx), toX = std::min(kLast, m_reach - dx);
      const int fromY = std::max(0, -m_reach - dy), toY = std::min(kLast, m_reach - dy);
      const std::uint64_t columns = ((2U << toY) - (1U << fromY)) * kEachRow;
      const std::uint64_t rows = kAll >> (kBlock * (kLast - toX + fromX)) << (kBlock * fromX);
      f(*block->second, columns & rows, dx, dy);
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
    Block& block = blockOf(x, y);
    count(block.patches[numberOf(x, y)]);
    block.known |= std::uint64_t{1} << numberOf(x, y);
    forNear(x, y, [](Block& near, std::uint64_t patches, int, int) { near.stale |= patches; });
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
  Block& block = blockOf(x, y);
  const std::uint64_t bit = std::uint64_t{1} << numberOf(x, y);
  UnknownPatch& prior = block.patches[numberOf(x, y)].prior;
  if (block.stale & bit) predict(x, y, prior);
  block.stale &= ~bit;
  return prior;
}

UnknownPatch LearnedPrior::lookAt(int x, int y) const {
  const auto found = m_blocks.find(keyOf(x / kBlock, y / kBlock));
  const std::size_t number = numberOf(x, y);
  const bool isThere = found != m_blocks.end();
  UnknownPatch prior = isThere ? found->second->patches[number].prior : UnknownPatch();
  if (!isThere || found->second->stale >> number & 1) predict(x, y, prior);
  return prior;
}

LearnedPrior::Near LearnedPrior::near(int x, int y) const {
  Near near{Distribution(m_standsOn.size(), 0)};
  forNear(x, y, [&](const Block& block, std::uint64_t patches, int dx, int dy) {
    for (std::uint64_t left = block.known & patches; left != 0; left &= left - 1) {
      const int number = __builtin_ctzll(left);
      const Patch& patch = block.patches[static_cast<std::size_t>(number)];
      const int i = dx + number / kBlock, j = dy + number % kBlock;
      const double weight = m_columnArea * m_kernel[static_cast<std::size_t>(i * i + j * j)];
      near.height += weight * patch.heights, near.heights += weight * patch.known;
      for (const auto& [id, columns] : patch.classes)
        near.ground[id] += weight * columns, near.classes += weight * columns;
    }
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

void LearnedPrior::predict(int x, int y, UnknownPatch& prior) const {
  const Near around = near(x, y);
  const Distribution g = ground(around);
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
