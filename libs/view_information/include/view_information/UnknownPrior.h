#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <view_information/BeamInformation.h>

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace view_information {

/** What a voxel does to a beam: P(a beam that reaches it passes on), and what observing it once
 * gains, nats. */
struct Gain {
  float pass = 1, gain = 0;
};

/** P(a beam passes) what is occupied with probability `occupied`. Not the sensor model's: its hit
 * probability is about beams that graze, but no beam gets through a wall; and where the filter
 * stops at `floor` (FilterParameters::minOccupancy), space is free. */
double passThrough(double occupied, double floor);

/** What unknown space is in the columns of one patch: nothing below the ground, ground one voxel
 * thick, what stands on it, free space above. */
struct UnknownPatch {
  static constexpr int kEdge = 4;  ///< voxels

  int ground = 0, top = 0;     ///< keys in z
  Gain onGround, above;        ///< at ground; from there to top
  std::uint16_t grounded = 0;  ///< one bit a column, x * kEdge + y: its ground is known

  /** \param x, y, z keys */
  Gain at(int x, int y, int z) const {
    const int h = z - ground, column = (x & (kEdge - 1)) * kEdge + (y & (kEdge - 1));
    if (h < 0 || (h <= 1 && (grounded >> column & 1))) return {0, 0};
    if (h == 0) return onGround;
    return z <= top ? above : Gain{};
  }
  /** What seeing the voxel below a free one tells: where the ground is lower than it was
   * expected, it is there. */
  Gain belowFree(int x, int y, int z) const { return at(x, y, z < ground ? ground : z); }
};

/** What space is of which the map knows nothing. Weights say which classes matter; only a prior
 * says where these may be. */
class UnknownPrior {
 public:
  virtual ~UnknownPrior() = default;
  /** The prior of the patch of keys kEdge * x, kEdge * y and on. Valid until what is known changes.
   */
  virtual const UnknownPatch& patch(int x, int y) = 0;
  /** Whether space that beams passed is air: nobody asks a second time about it, and beams get
   * through. Without, each look at it is worth what the filter makes of it. */
  virtual bool knowsAir() const = 0;
};

/** Everywhere the same: P(free) = 1/2, the classes equally likely. */
class UniformPrior : public UnknownPrior {
 public:
  UniformPrior(const Question& question, const BeamModel& model);
  const UnknownPatch& patch(int, int) override { return m_patch; }
  bool knowsAir() const override { return false; }

 private:
  UnknownPatch m_patch;
};

/** P(free) = 1/2, the classes equally likely: what the filter has of unknown space. */
std::vector<double> nothingKnown(int numClasses);

/** Learned from what is known. Ground goes on as near by, or else as on the whole. On it stands
 * what stands on such ground elsewhere; above is air. It says which outcomes to expect. What they
 * are worth is how far they move what is expected (Question::surprise()). On the ground that is
 * nothing yet, so that ground that is relevant for sure is worth most. Above it that is what is
 * there on the whole: air is worth nothing. */
class LearnedPrior : public UnknownPrior {
 public:
  /** \param map must outlive this. */
  LearnedPrior(const semantic_octree::SemanticOcTree& map, const Question& question);

  /** The ground of one column of voxels, x, y, z: keys, or what hides it. What stands on it is
   * looked up in the map. */
  void learn(int x, int y, int z, ClassId ground);
  const UnknownPatch& patch(int x, int y) override;
  /** The prior of a patch for who only looks on: nothing is remembered. */
  UnknownPatch lookAt(int x, int y) const;
  bool knowsAir() const override { return true; }
  /** Bytes. */
  std::size_t memoryUsage() const;

 private:
  static constexpr int kColumns = UnknownPatch::kEdge * UnknownPatch::kEdge;
  struct Ground {
    ClassId id;
    std::uint16_t z;  ///< key; 0: not known
  };
  struct Patch {
    std::array<Ground, kColumns> columns{};
    bool hasChanged = false;    ///< what is known, and it is among m_changed
    std::uint16_t known = 0;    ///< columns
    std::uint32_t heights = 0;  ///< their sum
    std::vector<std::pair<ClassId, std::uint16_t>> classes;  ///< columns of each
    UnknownPatch prior;
  };
  static constexpr int kBlock = 8;  ///< patches; blocks are looked up, patches are not
  static constexpr std::uint64_t kAll = ~std::uint64_t{0};
  struct Block {
    std::array<Patch, kBlock * kBlock> patches;
    std::uint64_t known = 0;     ///< one bit a patch: some of its ground is
    std::uint64_t stale = kAll;  ///< the same: its prior is
  };
  using Distribution = std::vector<double>;

  static std::uint64_t keyOf(int x, int y) {
    return std::uint64_t{static_cast<std::uint32_t>(x)} << 32 | static_cast<std::uint32_t>(y);
  }
  static std::size_t numberOf(int x, int y) {
    return static_cast<std::size_t>(x % kBlock * kBlock + y % kBlock);
  }
  Block& blockOf(int x, int y);
  template <class F>
  void forNear(int x, int y, F f) const;
  void count(Patch& patch);
  void spread();
  void learnAbove(int x, int y, int z, ClassId ground);
  void predict(int x, int y, UnknownPatch& prior) const;
  /** What is near a patch: the weight of each class of ground, and of heights. */
  struct Near {
    Distribution ground;
    double classes = 0, height = 0, heights = 0;
  };
  Near near(int x, int y) const;
  Distribution ground(const Near& near) const;
  Distribution above(const Distribution& ground) const;
  Distribution worthOf(const Distribution& before) const;
  Gain gainOf(const Distribution& p, const Distribution& worth) const;

  const semantic_octree::SemanticOcTree& m_map;
  const Question& m_question;
  BeamModel m_model;
  int m_reach;  ///< patches
  double m_columnArea;
  int m_usualHeight = semantic_octree::kKeyOfOrigin;  ///< where nothing near is known
  std::unordered_map<std::uint64_t, std::unique_ptr<Block>> m_blocks;
  std::vector<std::array<int, 2>> m_changed;
  std::vector<double> m_kernel;          ///< by squared distance in patches
  Distribution m_worthOfGround;          ///< of each outcome
  Distribution m_worthAbove;             ///< the same, above it
  std::vector<Distribution> m_standsOn;  ///< by class of ground: air and classes that were seen
};

}  // namespace view_information
