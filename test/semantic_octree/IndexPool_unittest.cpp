// The memory of nodes and class records.
#include <gtest/gtest.h>
#include <semantic_octree/store/IndexPool.h>

#include <cstring>
#include <random>
#include <set>
#include <thread>

using namespace semantic_octree;

namespace {

void write(const IndexPool& pool, std::uint32_t index, int value) {
  std::memcpy(pool.at(index), &value, sizeof(value));
}
int read(const IndexPool& pool, std::uint32_t index) {
  int value = 0;
  std::memcpy(&value, pool.at(index), sizeof(value));
  return value;
}

/** Elements, where they are, and what was written into all of them. */
struct Elements {
  std::uint32_t index;
  int length, content;
  const std::byte* address;
};

}  // namespace

TEST(IndexPool, ofSeveralThreadsGivesEachElementsOfItsOwn) {
  IndexPool pool(8);
  std::vector<std::vector<std::uint32_t>> indices(3);
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&pool, &mine = indices[t], t] {
      IndexAllocator allocator;
      for (int i = 0; i < 50000; ++i) {
        mine.push_back(allocator.allocate(pool));
        write(pool, mine.back(), t);
        if (read(pool, mine[i / 2]) != t) mine.clear();
      }
    });
  for (std::thread& thread : threads) thread.join();
  std::set<std::uint32_t> all;
  for (int t = 0; t < 3; ++t)
    for (const std::uint32_t index : indices[t]) {
      EXPECT_TRUE(all.insert(index).second);
      ASSERT_EQ(read(pool, index), t);
    }
  EXPECT_EQ(all.size(), 150000u);
}

TEST(IndexAllocator, runsOfEveryLengthAreApartAndStayWhereTheyAre) {
  std::mt19937 random(1);
  IndexPool pool(4);
  IndexAllocator allocator;
  std::vector<Elements> runs;
  for (int i = 0; i < 20000; ++i) {
    if (!runs.empty() && random() % 3 == 0) {
      std::swap(runs[random() % runs.size()], runs.back());
      allocator.release(runs.back().index, runs.back().length);
      runs.pop_back();
    }
    const int length = i % 4 ? 1 + static_cast<int>(random() % 64) : 1;
    const std::uint32_t index = allocator.allocate(pool, length);
    EXPECT_EQ(index / IndexPool::kPerChunk, (index + length - 1) / IndexPool::kPerChunk)
        << "in one piece";
    for (int k = 0; k < length; ++k) write(pool, index + k, i);
    runs.push_back({index, length, i, pool.at(index)});
    ASSERT_EQ(pool.at(index + length - 1) - pool.at(index), 4 * (length - 1));
  }
  for (const Elements& run : runs) {
    ASSERT_EQ(pool.at(run.index), run.address);
    for (int k = 0; k < run.length; ++k) ASSERT_EQ(read(pool, run.index + k), run.content);
  }
}
