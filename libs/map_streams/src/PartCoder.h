#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "StreamTree.h"

struct ZSTD_CDict_s;
struct ZSTD_DDict_s;

namespace semantic_octree {

/** By Zstandard. \param dictionary null: none */
std::string packed(const std::string& bytes, const ZSTD_CDict_s* dictionary = nullptr);
/** \param most bytes \throw std::runtime_error more, or altered. */
std::string unpacked(const std::string& packed, std::size_t most,
                     const ZSTD_DDict_s* dictionary = nullptr);

/** Parts of trees as bytes, and back, packed by Zstandard. What is frequent in a map, its sender
 * finds in all parts and tells once (toText()): leaves, which are then numbers of 8 bits, and a
 * dictionary. Bytes of one packet do not depend on those of others. */
class PartCoder {
 public:
  /** Knows nothing yet. \param rootDepth of the trees that parts belong to: octets are not above,
   * leaves that are no octet's are not below */
  PartCoder(int numClasses, int rootDepth);
  int rootDepth() const { return m_rootDepth; }
  /** Takes sorted parts of a packet. */
  using VisitGroup = std::function<void(const std::vector<const TreePart*>&)>;
  /** What is frequent in these. \param forEachGroup hands over all, the same each time */
  void learn(const std::function<void(const VisitGroup&)>& forEachGroup);

  /** \param parts at most 65535, sorted by cell */
  std::string encode(const std::vector<const TreePart*>& parts) const;
  /** \throw std::runtime_error bytes that no encoder writes. */
  std::vector<TreePart> decode(const std::string& bytes) const;

  std::string toText() const;
  /** \throw std::runtime_error as decode(). */
  void fromText(const std::string& text);

 private:
  std::string plain(const std::vector<const TreePart*>& parts) const;

  int m_numClasses, m_rootDepth;
  std::vector<std::string> m_frequent;  ///< leaves as bytes, sorted
  std::string m_dictionary;
  std::shared_ptr<const ZSTD_CDict_s> m_packing;    ///< a sender's
  std::shared_ptr<const ZSTD_DDict_s> m_unpacking;  ///< a receiver's
};

}  // namespace semantic_octree
