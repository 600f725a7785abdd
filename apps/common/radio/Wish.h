#pragma once
#include <map_streams/MapStream.h>
#include <semantic_abstraction/AbstractionOptions.h>
#include <semantic_types/ClassTable.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

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
  /** \throw std::runtime_error too long. */
  std::vector<semantic_octree::Datagram> requests(std::uint32_t stream) const;
};

/** Puts a wish together from its requests, in any order. */
class WishReader {
 public:
  /** \return the wish, when all of it came. \throw std::runtime_error altered. */
  std::optional<Wish> add(const semantic_octree::Datagram& request);

 private:
  std::size_t m_number = 0;
  std::map<std::size_t, std::string> m_parts;
};

}  // namespace radio
