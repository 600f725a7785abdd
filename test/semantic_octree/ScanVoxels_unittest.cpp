// A scan's voxels: where their bits are, their ranks, and what was voted for in them.
#include <gtest/gtest.h>
#include <semantic_octree/store/HitTiles.h>
#include <semantic_octree/store/HitVotes.h>
#include <semantic_octree/store/ScanGrid.h>

#include <map>
#include <random>
#include <set>

using namespace semantic_octree;

namespace {

int below(std::mt19937& random, int n) { return static_cast<int>(random() % unsigned(n)); }

ScanGrid randomGrid(std::mt19937& random) {
  VoxelIndex lowest, size;
  for (int axis = 0; axis < 3; ++axis) {
    lowest[axis] = below(random, 200) - 100;
    size[axis] = below(random, 90);
  }
  ScanGrid grid;
  grid.cover(lowest, lowest + size, 1 << 20);
  return grid;
}

VoxelIndex randomVoxel(std::mt19937& random, const ScanGrid& grid) {
  VoxelIndex voxel;
  for (int axis = 0; axis < 3; ++axis) voxel[axis] = below(random, 8 * grid.numTiles()[axis]);
  return voxel;
}

/** x lowest. */
unsigned mortonInTile(const VoxelIndex& voxel) {
  unsigned bit = 0;
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) bit |= unsigned(voxel[axis] >> i & 1) << (3 * i + axis);
  return bit;
}

}  // namespace

TEST(ScanVoxels, haveABitEachAndTheirTileAWordForEachBlock) {
  std::mt19937 random(1);
  for (int round = 0; round < 10; ++round) {
    ScanGrid grid = randomGrid(random);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(grid.words()) % ScanGrid::kBytesPerPage, 0u);
    std::set<std::uint64_t> bits;
    std::size_t expectedNumber = 0;
    grid.forEachTile([&](const VoxelIndex& tile, std::size_t number) {
      EXPECT_EQ(number, expectedNumber++);
      for (int i = 0; i < 512; ++i) {
        const VoxelIndex voxel = tile * 8 + VoxelIndex(i % 8, i / 8 % 8, i / 64);
        const ScanGrid::Place place = grid.placeOf(voxel);
        ASSERT_EQ(place.tile, number);
        ASSERT_EQ(place.bit, mortonInTile(voxel));
        ASSERT_TRUE(bits.insert(grid.bitOf(voxel)).second);
        ASSERT_EQ(grid.words() + grid.bitOf(voxel) / 64, grid.words(tile) + place.bit / 64);
      }
    });
    EXPECT_EQ(expectedNumber, grid.numTilesInAll());
    EXPECT_LE(*bits.rbegin() / 8, grid.bytes());
  }
}

TEST(ScanVoxels, haveNeighborsOneStepAway) {
  std::mt19937 random(2);
  for (int round = 0; round < 10; ++round) {
    const ScanGrid grid = randomGrid(random);
    for (int axis = 0; axis < 3; ++axis) {
      const ScanGrid::Field& field = grid.field(axis);
      const auto offset = [&](int i) { return std::int64_t(grid.offsets(axis)[i]); };
      for (int i = 1; i < 8 * grid.numTiles()[axis]; ++i) {
        ASSERT_EQ((offset(i - 1) + field.up()) & field.mask, offset(i));
        ASSERT_EQ((offset(i) + field.down()) & field.mask, offset(i - 1));
      }
    }
  }
}

TEST(ScanVoxels, ofFourTilesAlongEachAxisShareAPage) {
  std::mt19937 random(3);
  const auto pageOf = [](const ScanGrid& grid, const VoxelIndex& voxel) {
    return grid.bitOf(voxel) / (8 * ScanGrid::kBytesPerPage);
  };
  for (int round = 0; round < 10; ++round) {
    const ScanGrid grid = randomGrid(random);
    for (int i = 0; i < 1000; ++i) {
      const VoxelIndex a = randomVoxel(random, grid), b = randomVoxel(random, grid);
      EXPECT_EQ(pageOf(grid, a), pageOf(grid, a / 32 * 32));
      EXPECT_EQ(pageOf(grid, a) == pageOf(grid, b), (a / 32 == b / 32).all());
    }
  }
}

TEST(ScanVoxels, thatAreHitHaveRanksOfTheirOwnInMortonOrderWithinABlock) {
  std::mt19937 random(4);
  HitTiles hits;
  for (int round = 0; round < 10; ++round) {
    const ScanGrid grid = randomGrid(random);
    hits.cover(grid.numTilesInAll());
    std::set<std::pair<std::size_t, unsigned>> expected;
    for (int i = 0; i < 5000; ++i) {
      const ScanGrid::Place place = grid.placeOf(randomVoxel(random, grid) / 3);
      EXPECT_EQ(hits.testAndSet(place), !expected.emplace(place.tile, place.bit).second);
    }
    ASSERT_EQ(hits.rank(), expected.size());
    std::set<std::uint32_t> ranks;
    for (const auto& [tile, bit] : expected) {
      const std::uint32_t rank = hits.rankOf({tile, bit});
      EXPECT_LT(rank, expected.size());
      EXPECT_TRUE(ranks.insert(rank).second);
      const auto firstOfBlock = expected.lower_bound({tile, bit & ~63u});
      const auto before = std::distance(firstOfBlock, expected.find({tile, bit}));
      EXPECT_EQ(rank, hits.tile(tile).ranks[bit / 64] + before);
    }
    grid.forEachTile([&](const VoxelIndex&, std::size_t tile) {
      const auto first = expected.lower_bound({tile, 0u});
      EXPECT_EQ(hits.has(tile), first != expected.end() && first->first == tile);
      EXPECT_EQ(countBits(hits.tile(tile).words, ScanGrid::kWords),
                std::distance(first, expected.lower_bound({tile + 1, 0u})));
    });
  }
}

TEST(ScanVoxels, haveTheVotesOfEachLabelThatEndsThere) {
  std::mt19937 random(5);
  HitVotes votes;
  for (int round = 0; round < 50; ++round) {
    const int numVoxels = 1 + below(random, 50), classes = 1 + below(random, 255);
    semantic_types::LabeledCloud cloud;
    std::vector<std::uint32_t> voxels;
    std::map<std::uint32_t, std::map<int, std::uint32_t>> expected;
    for (int i = below(random, 2000); i > 0; --i) {
      const bool isSomewhere = random() % 5 > 0;
      voxels.push_back(isSomewhere ? unsigned(below(random, numVoxels)) : HitVotes::kNowhere);
      cloud.points.emplace_back(0, 0, 0);
      cloud.classes.push_back(static_cast<ClassId>(below(random, classes + 1)));
      if (isSomewhere && cloud.classes.back() != kNoClass)
        ++expected[voxels.back()][cloud.classes.back()];
    }
    votes.count(cloud, voxels, std::size_t(numVoxels), classes);
    for (int voxel = 0; voxel < numVoxels; ++voxel) {
      const HitVotes::Result result = votes.votesOf(unsigned(voxel));
      const auto& counts = expected[unsigned(voxel)];
      ASSERT_EQ(votes.hasVotes(unsigned(voxel)), !counts.empty());
      ASSERT_EQ(result.numVoted, counts.size());
      const ClassVotes* vote = result.votes.data();
      for (const auto& [id, count] : counts) {
        EXPECT_EQ(vote->id, id);
        EXPECT_EQ(vote++->count, count);
      }
    }
  }
}
