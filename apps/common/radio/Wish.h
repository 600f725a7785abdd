#pragma once
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>

#include <optional>
#include <string>

namespace radio {

/** What a receiver asks for: how much which class matters to it. */
struct Wish {
  std::string weights;          ///< text of a file of weights; empty: the sender's own
  std::string solution;         ///< its name; empty: the first
  std::optional<double> alpha;  ///< instead of the solution's

  /** What it keeps of a map of these classes. Without an alpha, all of the map.
   * \param name what messages call the weights
   * \throw std::runtime_error naming them: as semantic_octree::loadWeights(), or there is no such
   * solution, or there are none at all. */
  semantic_octree::AbstractionOptions forClasses(const semantic_types::ClassTable& classes,
                                                 const std::string& name) const;
  /** For a request, which is one datagram: with a cookie before it. \throw std::runtime_error too
   * long. */
  std::string packed() const;
  /** \throw std::runtime_error altered. */
  static Wish of(const std::string& packed);
};

}  // namespace radio
