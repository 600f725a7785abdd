#pragma once
#include <functional>
#include <istream>

#include "RangeCoder.h"
#include "StreamTree.h"

namespace semantic_octree {

/** Parts of trees as bytes, and back. What is frequent in a map, its sender finds in all parts and
 * tells once (toText()): values and class records, which are then numbers of 8 bits, and how likely
 * each bit is. Bytes of one packet do not depend on those of others. */
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
  /** \throw std::runtime_error bytes that no encoder writes; at most 65535 parts else. */
  std::vector<TreePart> decode(const std::string& bytes) const;

  std::string toText() const;
  /** \throw std::runtime_error as decode(). \param next where it begins in the text, and ends */
  void fromText(const std::string& text, std::size_t& next);

 private:
  template <typename Coder>
  friend class PartFormat;
  void checkRecords() const;

  int m_numClasses, m_rootDepth;
  /** By frequency, at most 255 of each. */
  std::vector<Units> m_plain, m_rests, m_differences;
  std::vector<StreamLeaf> m_records;
  BitModels m_models;
};

}  // namespace semantic_octree
