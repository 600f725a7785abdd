#include <gtest/gtest.h>
#include <view_information/BeamInformation.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

using namespace view_information;
using semantic_octree::ClassFilter;
using semantic_octree::FilterParameters;
using tree_abstraction::AbstractionWeights;
using tree_abstraction::InformationTerm;

namespace {

using Distribution = std::vector<double>;
using Cells = std::vector<Distribution>;
using Map = std::vector<int>;
/** Is told an outcome (a number of its own) and its probability. */
using Tell = std::function<void(long, double)>;
/** Tells all outcomes of looking at a map. */
using Look = std::function<void(const Map&, const Tell&)>;

/** All that is drawn for these tests; the seed is fixed. */
class Draw {
 public:
  explicit Draw(unsigned seed) : m_random(seed) {}
  double number() { return static_cast<double>(m_random() >> 11) * 0x1p-53; }
  int below(int n) { return static_cast<int>(number() * n); }

  Distribution distribution(int K) {
    Distribution p(static_cast<std::size_t>(K) + 1);
    const double sharp = 0.3 + 3 * number();
    double sum = 0;
    for (double& x : p) sum += x = std::pow(number(), sharp) + 1e-6;
    if (number() < 0.1) sum -= std::exchange(p[1], 0);
    for (double& x : p) x /= sum;
    return p;
  }
  Cells cells(int count, int K) {
    Cells cells;
    for (int i = 0; i < count; ++i) cells.push_back(distribution(K));
    return cells;
  }
  BeamModel model(int K) {
    FilterParameters parameters;
    parameters.hitProbability = 0.3 + 0.6 * number();
    parameters.falseAlarmProbability = 0.01 + 0.2 * number();
    parameters.accuracy = 0.55 + 0.4 * number();
    return {K, parameters};
  }
  /** Two or three groups, of which free space may be a part. */
  InformationTerm term(int K, double weight) {
    InformationTerm term{"term", weight, {}};
    std::vector<std::vector<int>> groups(3);
    for (int k = 0; k <= K; ++k) groups[static_cast<std::size_t>(below(3))].push_back(k);
    for (auto& group : groups)
      if (!group.empty()) term.groups.push_back(group);
    return term;
  }
  std::mt19937_64& random() { return m_random; }

 private:
  std::mt19937_64 m_random;
};

AbstractionWeights weightsOf(std::vector<InformationTerm> terms) {
  AbstractionWeights weights;
  weights.terms = std::move(terms);
  return weights;
}

int groupOf(const InformationTerm& term, int k) {
  for (std::size_t g = 0; g < term.groups.size(); ++g)
    for (const int id : term.groups[g])
      if (id == k) return static_cast<int>(g);
  return 7;
}

void forEachMap(std::size_t cells, int K, const std::function<void(const Map&)>& f) {
  Map m(cells, 0);
  for (std::size_t i = 0; i < cells;) {
    f(m);
    for (i = 0; i < cells && ++m[i] > K; ++i) m[i] = 0;
  }
}

/** I(Y; z) by the joint table of all maps and all measurements. */
double byEnumeration(const Cells& cells, int K, const InformationTerm& term, const Look& look) {
  std::map<std::pair<long, long>, double> joint;
  std::map<long, double> py, pz;
  forEachMap(cells.size(), K, [&](const Map& m) {
    double pm = 1;
    long y = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
      pm *= cells[i][static_cast<std::size_t>(m[i])];
      y = y * 8 + groupOf(term, m[i]);
    }
    look(m, [&](long z, double p) { joint[{y, z}] += pm * p, py[y] += pm * p, pz[z] += pm * p; });
  });
  double sum = 0;
  for (const auto& [yz, p] : joint)
    if (p > 0) sum += p * std::log(p / (py[yz.first] * pz[yz.second]));
  return sum;
}

/** The first return of a beam, and its label. */
void lookAlong(const BeamModel& model, const Map& m, const std::vector<int>& beam,
               const Tell& tell) {
  double reached = 1;
  for (const int i : beam) {
    const int cell = m[static_cast<std::size_t>(i)];
    for (int c = 1; c <= model.numClasses(); ++c)
      tell(i * 10 + c, reached * model.probability(c, cell));
    reached *= model.probability(0, cell);
  }
  tell(-1, reached);
}

/** Outcomes of all cells that some beam reaches, each observed once. */
void lookAtNet(const BeamModel& model, const Map& m, const std::vector<std::vector<int>>& beams,
               const Tell& tell) {
  const auto isReached = [&](int cell, unsigned open) {
    return std::any_of(beams.begin(), beams.end(), [&](const std::vector<int>& beam) {
      for (const int i : beam) {
        if (i == cell) return true;
        if (!(open >> i & 1)) return false;
      }
      return false;
    });
  };
  const std::function<void(int, long, double, unsigned)> goOn = [&](int i, long z, double p,
                                                                    unsigned open) {
    if (i == static_cast<int>(m.size())) return tell(z, p);
    if (!isReached(i, open)) return goOn(i + 1, z * 8 + 7, p, open);
    for (int w = 0; w <= model.numClasses(); ++w)
      goOn(i + 1, z * 8 + w, p * model.probability(w, m[static_cast<std::size_t>(i)]),
           w == 0 ? open | 1U << i : open);
  };
  goOn(0, 0, 1, 0);
}

std::vector<int> allOf(std::size_t count) {
  std::vector<int> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(static_cast<int>(i));
  return all;
}

/** The cells with what an observation of each is worth; nobody's parents are set. */
std::vector<TreeCell> valued(const Cells& cells, const BeamModel& model, const Question& question) {
  std::vector<TreeCell> valued;
  for (const Distribution& p : cells)
    valued.push_back({-1, model.pass(p.data()), question.information(model, p.data())});
  return valued;
}

TEST(BeamInformation, isThatOfAllMapsAndMeasurements) {
  Draw draw(1);
  for (int trial = 0; trial < 200; ++trial) {
    const int K = 1 + draw.below(3);
    const Cells cells = draw.cells(1 + draw.below(4), K);
    const BeamModel model = draw.model(K);
    const InformationTerm term = draw.term(K, 1);
    const double exact = byEnumeration(cells, K, term, [&](const Map& m, const Tell& tell) {
      lookAlong(model, m, allOf(m.size()), tell);
    });
    std::vector<CellRun> beam;
    for (const TreeCell& c : valued(cells, model, Question(weightsOf({term}), K)))
      beam.push_back({c.pass, c.value, 1});
    ASSERT_NEAR(informationOfBeam(beam), exact, 1e-12) << "trial " << trial;
  }
}

TEST(BeamInformation, ofARunOfEqualCellsIsThatOfTheCells) {
  Draw draw(2);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 1 + draw.below(50);
    const double pass = trial == 0 ? 1 : draw.number(), value = draw.number();
    const CellRun wall{0.3, draw.number(), 1};
    std::vector<CellRun> one(static_cast<std::size_t>(count), CellRun{pass, value, 1});
    one.push_back(wall);
    EXPECT_NEAR(informationOfBeam({{pass, value, count}, wall}), informationOfBeam(one), 1e-12);
  }
}

TEST(BeamInformation, ofAViewThatIsATreeIsThatOfAllMapsAndMeasurements) {
  Draw draw(3);
  for (int trial = 0; trial < 100; ++trial) {
    const int K = 1 + draw.below(2);
    const Cells cells = draw.cells(3 + draw.below(2), K);
    const BeamModel model = draw.model(K);
    const InformationTerm term = draw.term(K, 1);
    std::vector<TreeCell> tree = valued(cells, model, Question(weightsOf({term}), K));
    std::vector<std::vector<int>> beams{{0}};
    for (int i = 1; i < static_cast<int>(tree.size()); ++i) {
      const int parent = draw.below(i);
      tree[static_cast<std::size_t>(i)].parent = parent;
      beams.push_back(beams[static_cast<std::size_t>(parent)]);
      beams.back().push_back(i);
    }
    const double exact = byEnumeration(
        cells, K, term, [&](const Map& m, const Tell& tell) { lookAtNet(model, m, beams, tell); });
    ASSERT_NEAR(informationOfTree(tree), exact, 1e-12) << "trial " << trial;
  }
}

TEST(BeamInformation, ofBeamsThatCrossIsWithinItsBounds) {
  Draw draw(4);
  int apart = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const int K = 1 + draw.below(2), count = 3 + draw.below(2);
    const Cells cells = draw.cells(count, K);
    const BeamModel model = draw.model(K);
    const InformationTerm term = draw.term(K, 1);
    std::vector<std::vector<int>> beams(3);
    for (auto& beam : beams)
      for (int i = 0; i < count; ++i)
        if (draw.number() < 0.6) beam.push_back(i);
    const double exact = byEnumeration(
        cells, K, term, [&](const Map& m, const Tell& tell) { lookAtNet(model, m, beams, tell); });
    const Bounds bounds =
        informationOfNet(valued(cells, model, Question(weightsOf({term}), K)), beams);
    ASSERT_LE(bounds.lower, exact + 1e-12) << "trial " << trial;
    ASSERT_GE(bounds.upper, exact - 1e-12) << "trial " << trial;
    apart += bounds.upper > bounds.lower + 1e-6;
  }
  EXPECT_GT(apart, 300);
}

TEST(BeamInformation, ofSeveralViewsIsWithinItsBounds) {
  Draw draw(5);
  for (int trial = 0; trial < 60; ++trial) {
    const int K = 2;
    const Cells cells = draw.cells(3, K);
    const BeamModel model = draw.model(K);
    const InformationTerm term = tree_abstraction::wholeClassVariable("all", 1, K);
    std::vector<std::vector<int>> orders(2, {0, 1, 2});
    for (auto& order : orders) std::shuffle(order.begin(), order.end(), draw.random());
    const double exact = byEnumeration(cells, K, term, [&](const Map& m, const Tell& tell) {
      lookAlong(model, m, orders[0], [&](long a, double pa) {
        lookAlong(model, m, orders[1], [&](long b, double pb) { tell(a * 100 + b, pa * pb); });
      });
    });
    const auto worth = valued(cells, model, Question(weightsOf({term}), K));
    std::vector<std::vector<double>> reached(2, std::vector<double>(3));
    std::vector<double> values;
    for (const TreeCell& c : worth) values.push_back(c.value);
    for (std::size_t v = 0; v < 2; ++v) {
      double p = 1;
      for (const int i : orders[v]) {
        reached[v][static_cast<std::size_t>(i)] = p;
        p *= worth[static_cast<std::size_t>(i)].pass;
      }
    }
    const Bounds bounds = informationOfViews(reached, values);
    ASSERT_LE(bounds.lower, exact + 1e-12) << "trial " << trial;
    ASSERT_GE(bounds.upper, exact - 1e-12) << "trial " << trial;
  }
}

TEST(BeamInformation, throughAFilterFarFromItsLimitsIsTheInformation) {
  Draw draw(6);
  const int K = 3;
  FilterParameters far;
  far.minOccupancy = 1e-7, far.maxProbability = 1 - 1e-7;
  const ClassFilter filter(K, far);
  const BeamModel model(K, far);
  for (int trial = 0; trial < 100; ++trial) {
    const Question question(weightsOf({draw.term(K, 0.5 + draw.number())}), K);
    auto belief = filter.uniform(0);
    for (int n = draw.below(4); n > 0; --n) {
      const int w = draw.below(K + 1);
      w > 0 ? filter.hit(belief, static_cast<ClassId>(w)) : filter.miss(belief);
    }
    Distribution p(K + 1);
    belief.distribution(K, p.data());
    EXPECT_NEAR(question.entropy(belief), question.entropy(p.data()), 1e-9);
    // The filter's increments are multiples of 1/1024.
    EXPECT_NEAR(question.fallThrough(filter, model, belief), question.information(model, p.data()),
                2e-3);
  }
}

TEST(BeamInformation, throughTheFilterEndsAtItsLimits) {
  const int K = 3;
  const FilterParameters parameters;
  const ClassFilter filter(K, parameters);
  const BeamModel model(K, parameters);
  const Question question(weightsOf({tree_abstraction::wholeClassVariable("all", 1, K)}), K);
  const auto lowest = filter.uniform(filter.lowestOccupancy());
  Distribution p(K + 1);
  lowest.distribution(K, p.data());
  EXPECT_GT(question.information(model, p.data()), 0.05);
  EXPECT_LT(question.fallThrough(filter, model, lowest), 1e-6);
}

TEST(BeamInformation, ofWhatIsToBeIgnoredIsNoGainAtTheFiltersLimits) {
  const int K = 3;
  const FilterParameters parameters;
  const ClassFilter filter(K, parameters);
  const BeamModel model(K, parameters);
  const Question question(weightsOf({tree_abstraction::irrelevant("b", 1, {1})}), K);
  for (const ClassId id : {1, 2}) {
    auto belief = filter.uniform(0);
    for (int hits = 0; hits < 4; ++hits) filter.hit(belief, id);
    for (int misses = 0; misses < 8; ++misses, filter.miss(belief))
      EXPECT_LE(question.fallThrough(filter, model, belief), 0) << id << ", " << misses;
  }
}

TEST(BeamInformation, isTheMeanSurpriseOfAllOutcomes) {
  Draw draw(7);
  for (int trial = 0; trial < 200; ++trial) {
    const int K = 1 + draw.below(4);
    const Distribution p = draw.distribution(K);
    const BeamModel model = draw.model(K);
    const Question question(weightsOf({draw.term(K, draw.number() - 0.5)}), K);
    double mean = 0;
    for (int w = 0; w <= K; ++w)
      mean += model.probability(w, p.data()) * question.surprise(model, p.data(), w);
    ASSERT_NEAR(mean, question.information(model, p.data()), 1e-12) << "trial " << trial;
  }
}

/** Weights times I_Y of the tree with these leaves: sum of shares of H(mean) - H(cell). */
double objectiveOf(const Question& question, const Cells& cells) {
  Distribution mean(cells[0].size(), 0);
  double left = 0;
  for (const Distribution& p : cells) {
    for (std::size_t k = 0; k < p.size(); ++k) mean[k] += p[k] / static_cast<double>(cells.size());
    left += question.entropy(p.data()) / static_cast<double>(cells.size());
  }
  return question.entropy(mean.data()) - left;
}

/** Cells that are seen one through the other, by a beam. */
struct Looking {
  const BeamModel& model;
  const Question& question;
  Cells cells;

  std::vector<double> reached(std::size_t count) const {
    std::vector<double> reached(cells.size(), 0);
    double now = 1;
    for (std::size_t i = 0; i < count; ++i)
      reached[i] = std::exchange(now, now * model.pass(cells[i].data()));
    return reached;
  }
  /** Expected objective after all that a beam through cells i, i + 1, ... may find. */
  double expectedAfter(std::size_t i, std::size_t end) {
    if (i == end) return objectiveOf(question, cells);
    double sum = 0;
    const Distribution before = cells[i];
    for (int w = 0; w <= model.numClasses(); ++w) {
      cells[i] = model.after(w, before.data());
      sum += model.probability(w, before.data()) * expectedAfter(w == 0 ? i + 1 : end, end);
    }
    cells[i] = before;
    return sum;
  }
};

}  // namespace

TEST(GrowthOfTree, liesBetweenItsBounds) {
  Draw draw(11);
  for (int trial = 0; trial < 1000; ++trial) {
    const int K = 1 + draw.below(3);
    const BeamModel model = draw.model(K);
    const Question question(weightsOf({draw.term(K, draw.number() - 0.5)}), K);
    Looking looking{model, question, draw.cells(2 + draw.below(5), K)};
    const std::size_t seen = 1 + static_cast<std::size_t>(draw.below(3)) % looking.cells.size();
    const double growth = looking.expectedAfter(0, seen) - objectiveOf(question, looking.cells);
    const Bounds bounds = growthOfTree(question, model, looking.cells, looking.reached(seen),
                                       std::vector<double>(looking.cells.size(), 1));
    ASSERT_GE(growth, bounds.lower - 1e-12) << "trial " << trial;
    ASSERT_LE(growth, bounds.upper + 1e-12) << "trial " << trial;
  }
}

TEST(GrowthOfTree, hasBoundsNearEachOtherWhereTheTreeIsLarge) {
  constexpr int K = 3;
  Draw draw(12);
  const BeamModel model = draw.model(K);
  const Question question(weightsOf({tree_abstraction::relevant("a", 1, {1, 2})}), K);
  const Looking looking{model, question, draw.cells(200, K)};
  const Bounds bounds = growthOfTree(question, model, looking.cells, looking.reached(12),
                                     std::vector<double>(looking.cells.size(), 1));
  EXPECT_LT(bounds.upper - bounds.lower, 0.05 * bounds.upper);
}

TEST(GrowthOfTree, ofACellThatStandsForThreeIsThatOfThree) {
  constexpr int K = 3;
  Draw draw(13);
  const BeamModel model = draw.model(K);
  const Question question(weightsOf({tree_abstraction::relevant("a", 1, {1, 2})}), K);
  const auto cells = draw.cells(2, K);
  const Bounds once = growthOfTree(question, model, cells, {0.4, 0.7}, {3, 1});
  const Bounds each = growthOfTree(question, model, {cells[0], cells[0], cells[0], cells[1]},
                                   {0.4, 0.4, 0.4, 0.7}, {1, 1, 1, 1});
  EXPECT_NEAR(once.lower, each.lower, 1e-15);
  EXPECT_NEAR(once.upper, each.upper, 1e-15);
}

TEST(BeamInformation, ofWhatIsIrrelevantIsALoss) {
  const int K = 3;
  const Question question(weightsOf({tree_abstraction::relevant("a", 1, {1}),
                                     tree_abstraction::irrelevant("b", 1, {2})}),
                          K);
  const BeamModel model(K, FilterParameters());
  const Distribution onlyA{0.5, 0.5, 0, 0}, onlyB{0.5, 0, 0.5, 0};
  EXPECT_GT(question.information(model, onlyA.data()), 0.01);
  EXPECT_NEAR(question.information(model, onlyA.data()), -question.information(model, onlyB.data()),
              1e-15);
}

TEST(BeamInformation, kindsAreClassesThatNoTermTellsApart) {
  const Question question(weightsOf({tree_abstraction::relevant("a", 1, {2, 4}),
                                     tree_abstraction::irrelevant("b", 1, {3})}),
                          5);
  EXPECT_EQ(question.kinds(), (std::vector<int>{0, 1, 2, 3, 2, 1}));
}
