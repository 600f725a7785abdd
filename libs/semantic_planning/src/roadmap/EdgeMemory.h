#pragma once
#include <semantic_planning/roadmap/PosePair.h>

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>
#include "ground/ColumnGrid.h"

namespace semantic_planning {

/** What was found about the curves between poses of the map. Plans ask for the same ones again: an
 * answer holds as long as no ground near the curve changes, and is what the checker would say. */
class EdgeMemory {
 public:
  /** \param checker must outlive the memory. */
  explicit EdgeMemory(const CollisionChecker& checker) : m_checker(checker) {}

  /** CollisionChecker::profile() of the pair's curve. */
  std::optional<colored_graph::EdgeProfile> profile(const PosePair& poses);
  /** The checker's answers may be others now where curves come near these tiles. */
  void groundChanged(const std::vector<Column>& tiles);

  void forget() { m_answers.clear(); }

  /** Answers that were known, since the last call. */
  std::size_t takeRemembered() { return std::exchange(m_remembered, 0); }

 private:
  struct Hash {
    std::size_t operator()(const PosePair& poses) const;
  };
  struct Answer {
    std::optional<colored_graph::EdgeProfile> profile;
    std::uint32_t time = 0;  ///< when it was known to hold
  };
  bool holds(const PosePair& poses, std::uint32_t time) const;

  const CollisionChecker& m_checker;
  std::unordered_map<PosePair, Answer, Hash> m_answers;
  ColumnGrid<std::uint32_t> m_changed;  ///< when tiles did last
  std::uint32_t m_now = 0;              ///< counts the changes
  std::size_t m_remembered = 0;
};

}  // namespace semantic_planning
