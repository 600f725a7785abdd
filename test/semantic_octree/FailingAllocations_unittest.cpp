#include <gtest/gtest.h>
#include <semantic_octree/Abstraction.h>
#include <semantic_octree/MapOperations.h>
#include <semantic_octree/TreeFile.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <sstream>

#include "RandomScans.h"

using namespace semantic_octree;

namespace {

/** Allocations until one fails; below 0: none does. */
std::atomic<long> allocationsLeft{-1};

bool fails() {
  if (allocationsLeft.load(std::memory_order_relaxed) < 0) return false;
  return allocationsLeft.fetch_sub(1) == 0;
}

}  // namespace

#define NOT_INLINE __attribute__((noinline))
NOT_INLINE void* operator new(std::size_t size) {
  void* memory = fails() ? nullptr : std::malloc(size);
  if (!memory) throw std::bad_alloc();
  return memory;
}
NOT_INLINE void operator delete(void* memory) noexcept { std::free(memory); }
NOT_INLINE void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

SemanticOcTree mapOf(unsigned seed, int numScans, bool withAbstraction) {
  std::mt19937 random(seed);
  SemanticOcTree map(0.5, numberedClasses(5));
  if (withAbstraction) {
    AbstractionOptions options;
    options.weights.terms = {tree_abstraction::relevant("1", 1, {1}),
                             tree_abstraction::irrelevant("2", 0.5, {2})};
    options.weights.alpha = 0.01;
    map.setAbstraction(options);
  }
  for (int i = 0; i < numScans; ++i) {
    const PosedCloud scan = randomScan(random);
    map.insert(scan.cloud, scan.T_map_sensor);
  }
  return map;
}

/** Fails the first, the second, ... allocation of an operation on a map, until none is left to
 * fail. After a failure the map must be what it was, or say that it is broken.
 * \return how often it failed; `broken`: how often the map was lost */
template <typename F>
int sweep(const SemanticOcTree& before, const F& operation, int* broken = nullptr) {
  for (int n = 0;; ++n) {
    SemanticOcTree map = before;
    bool failed = false;
    allocationsLeft = n;
    try {
      operation(map);
    } catch (const std::exception&) {
      failed = true;
    }
    allocationsLeft = -1;
    if (!failed) return n;
    if (map.isBroken()) {
      EXPECT_NE(broken, nullptr) << "allocation " << n;
      if (broken) ++*broken;
      EXPECT_THROW(map.size(), std::logic_error);
      EXPECT_THROW(map.root(), std::logic_error);
      EXPECT_THROW(SemanticOcTree copy(map), std::logic_error);
      map.clear();
      EXPECT_TRUE(map.empty());
    } else if (!(map == before)) {
      ADD_FAILURE() << "allocation " << n << " left another map behind";
      return n;
    }
  }
}

}  // namespace

TEST(FailingAllocations, whileAScanIsInsertedLeaveTheMapOrABrokenOne) {
  std::mt19937 random(3);
  const PosedCloud scan = randomScan(random);
  int broken = 0, failures = 0;
  for (const bool withAbstraction : {false, true})
    for (const int threads : {1, 2}) {
      InsertionOptions options;
      options.threads = threads;
      failures += sweep(
          mapOf(4, 2, withAbstraction),
          [&](SemanticOcTree& map) { map.insert(scan.cloud, scan.T_map_sensor, options); },
          &broken);
    }
  EXPECT_GT(broken, 0);
  EXPECT_LT(broken, failures);
}

TEST(FailingAllocations, elsewhereLeaveTheMapAsItWas) {
  const SemanticOcTree map = mapOf(5, 2, true), other = mapOf(6, 1, false);
  std::stringstream file;
  writeTree(file, map);
  const std::string bytes = file.str();
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { SemanticOcTree copy = m; }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { m.setAbstraction(Abstraction(m).options()); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { Abstraction(m).leaves(); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { Abstraction(m).alphaPath(); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { Abstraction(m).compressedMap(); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { m.takeTouchedTiles(); }), 3);
  EXPECT_GT(sweep(map, [&](SemanticOcTree& m) { merged({&m, &other}); }), 3);
  EXPECT_GT(sweep(map, [](SemanticOcTree& m) { coarsened(m, 1); }), 3);
  EXPECT_GT(sweep(map,
                  [&](SemanticOcTree& m) {
                    std::istringstream in(bytes);
                    m = readTree(in);
                  }),
            3);
}

TEST(FailingAllocations, ofTheCompressedTreesChangeAreRemembered) {
  const SemanticOcTree before = mapOf(7, 2, true);
  int lost = 0;
  for (int n = 0;; ++n) {
    SemanticOcTree map = before;
    allocationsLeft = n;
    bool failed = false;
    try {
      Abstraction(map).takeChange();
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    allocationsLeft = -1;
    if (!failed) break;
    ++lost;
    EXPECT_THROW(Abstraction(map).takeChange(), std::logic_error);
    EXPECT_TRUE(map == before);
  }
  EXPECT_GT(lost, 3);
}

TEST(FailingAllocations, whileAMapIsSavedLeaveTheOldFile) {
  const SemanticOcTree old = mapOf(8, 1, false);
  const std::string path = testing::TempDir() + "failing_allocations.semantic";
  saveTree(old, path);
  EXPECT_GT(sweep(mapOf(9, 2, false),
                  [&](SemanticOcTree& map) {
                    struct Check {
                      ~Check() { allocationsLeft = -1; }
                    } check;
                    saveTree(map, path);
                  }),
            3);
  saveTree(old, path);
  EXPECT_TRUE(loadTree(path) == old);
}
