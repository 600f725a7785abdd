#pragma once
#include <semantic_map/MapOptions.h>

namespace semantic_map {

/** Calls visit(key, option, explanation) for each option, in the order in which archives hold them.
 * The one place that knows the options' names. \tparam Options may be const */
template <class Derived>
struct OptionFields;

template <>
struct OptionFields<TCreationOptions> {
  template <class Options, class Visitor>
  static void visit(Options& o, Visitor&& visit) {
    visit("resolution", o.resolution, "edge of a voxel, m");
    visit("classes", o.classes, "class table, relative to the working directory");
  }
};

template <>
struct OptionFields<TInsertionOptions> {
  template <class Options, class Visitor>
  static void visit(Options& o, Visitor&& visit) {
    visit("rays", o.scan.rays, "All, or one for each of EndVoxels (faster)");
    visit("maxRange", o.scan.maxRange, "m, returns beyond it only carve; 0: no limit");
    visit("minRange", o.scan.minRange, "m, nearer returns are ignored");
    visit("carvingMargin", o.scan.carvingMargin, "m before a return that are not carved");
    visit("threads", o.scan.threads, "that share the work on a scan");
    visit("decimation", o.conversion.decimation,
          "one point for a block of that many pixels squared");
    visit("flyingPixelThreshold", o.conversion.flyingPixelThreshold,
          "share of their depth by which pixels at depth edges may hang in the air; 0: keep all");
    visit("increments", o.filter.increments, "LikelihoodConsistent, or the constants of Ssmi");
    visit("accuracy", o.filter.accuracy, "share of labels that name the true class");
    visit("hitProbability", o.filter.hitProbability, "P(return | cell occupied and reached)");
    visit("falseAlarmProbability", o.filter.falseAlarmProbability, "P(return | cell free)");
    visit("minOccupancy", o.filter.minOccupancy, "occupancy of what was seen free for long");
    visit("maxProbability", o.filter.maxProbability, "of a class that was seen for long");
    visit("softLabelFloor", o.filter.softLabelFloor, "least probability in a soft label");
  }
};

template <>
struct OptionFields<TLikelihoodOptions> {
  template <class Options, class Visitor>
  static void visit(Options& o, Visitor&& visit) {
    visit("decimation", o.decimation, "one of that many points counts");
    visit("useLabels", o.useLabels, "compare classes too, not only occupancy");
    visit("beamStep", o.beamStep, "m between places where a beam passes; 0: only its end counts");
    visit("pointWeight", o.pointWeight, "factor on each point's log-likelihood");
  }
};

template <>
struct OptionFields<TAbstractionOptions> {
  template <class Options, class Visitor>
  static void visit(Options& o, Visitor&& visit) {
    visit("relevant", o.relevant, "classes worth keeping, \"road: 1, car+truck: 0.5\"");
    visit("irrelevant", o.irrelevant, "classes worth dropping");
    visit("everything", o.everything, "weight of the whole class variable");
    visit("alpha", o.alpha, "price of compression, per nat of I_X");
    visit("unknown", o.unknown, "OwnClass, Uniform or Prior");
    visit("unknownWeight", o.unknownWeight, "of unknown space relative to known");
    visit("blockSize", o.blockSize, "m, blocks inside which unknown space counts; 0: none");
    visit("frame", o.frame, "nodes above the blocks: Free or Charged");
    visit("regions", o.regions, "box x0 y0 z0 x1 y1 z1 weight; sphere x y z radius weight; ...");
  }
};

template <>
struct OptionFields<TRenderingOptions> {
  template <class Options, class Visitor>
  static void visit(Options& o, Visitor&& visit) {
    visit("coloring", o.coloring, "Class, Probability, Height or Entropy");
    visit("occupied", o.occupied, "show occupied cells");
    visit("free", o.free, "show free cells");
    visit("compressed", o.compressed, "show the optimal abstraction, where one is kept");
    visit("minOccupancy", o.minOccupancy, "above it, cells are occupied");
    visit("minProbability", o.minProbability, "of the likeliest class of occupied cells");
    visit("minHeight", o.minHeight, "m, lower cells are left out");
    visit("maxHeight", o.maxHeight, "m, higher cells are left out");
  }
};

}  // namespace semantic_map
