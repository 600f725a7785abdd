#pragma once

namespace semantic_planning {

/** What of a ground voxel's class distribution counts. */
struct ClassReading {
  enum class Kind {
    Likeliest,  ///< the likeliest class (of the bridged ground: see GroundOptions)
    Expected,   ///< each class, with its probability: lengths per class are expected lengths
    Cautious    ///< the worst class whose probability exceeds `bound`
  };
  Kind kind = Kind::Likeliest;
  /** Cautious: the bound. Expected: less probable classes do not count. (0, 1) */
  double bound = 0.1;

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

}  // namespace semantic_planning
