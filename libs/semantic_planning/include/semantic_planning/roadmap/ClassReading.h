#pragma once

namespace semantic_planning {

/** What of a ground voxel's class distribution counts. */
struct ClassReading {
  enum class Kind {
    Likeliest,  ///< the likeliest class (of filled ground: see GroundOptions)
    Expected,   ///< each class, with its probability: lengths per class are expected lengths
    Cautious    ///< the worst class whose probability exceeds `leastProbability`
  };
  Kind kind = Kind::Likeliest;
  /** Cautious: more probable classes count. Expected: less probable classes do not count. (0, 1) */
  double leastProbability = 0.1;

  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

}  // namespace semantic_planning
