#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_octree/TreeFile.h>

#include <istream>
#include <ostream>
#include <stdexcept>

#include "ArchiveStream.h"

IMPLEMENTS_SERIALIZABLE(CSemanticOctoMap, CMetricMap, semantic_map)

namespace semantic_map {

using mrpt::serialization::CArchive;

namespace {

/** Below IMPLEMENTS_SERIALIZABLE, which gives the class its name while statics are initialized;
 * MRPT_INITIALIZER may come before that. */
[[maybe_unused]] const bool kIsRegistered =
    (mrpt::rtti::registerClass(CLASS_ID(CSemanticOctoMap)), true);

}  // namespace

uint8_t CSemanticOctoMap::serializeGetVersion() const { return 2; }

void CSemanticOctoMap::serializeTo(CArchive& out) const {
  const auto lock = reading();
  if (m_folder) folder()->checkFits();  // whoever reads the archive has all of it in memory
  out << genericMapParams;
  insertionOptions.writeTo(out);
  likelihoodOptions.writeTo(out);
  renderingOptions.writeTo(out);
  m_abstractionOptions.writeTo(out);
  ArchiveStreambuf buffer(out);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);  // rethrows what the archive threw
  semantic_octree::writeTree(stream, m_tree);
}

void CSemanticOctoMap::serializeFrom(CArchive& in, uint8_t version) {
  if (version != 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  checkMayBecomeAnother();
  mrpt::maps::TMapGenericParams generic;
  TInsertionOptions insertion;
  TLikelihoodOptions likelihood;
  TRenderingOptions rendering;
  TAbstractionOptions abstractions;
  in >> generic;
  insertion.readFrom(in);
  likelihood.readFrom(in);
  rendering.readFrom(in);
  abstractions.readFrom(in);
  ArchiveStreambuf buffer(in);
  std::istream stream(&buffer);
  semantic_octree::SemanticOcTree tree = semantic_octree::readTree(stream);
  if (abstractions.isSet()) semantic_octree::setAbstraction(tree, abstractions);

  m_tree = std::move(tree);
  m_abstractionOptions = abstractions;
  genericMapParams = generic;
  insertionOptions = insertion;
  auto& filter = insertionOptions.filter;  // what of it has no name is in the tree alone
  filter.minOccupancy = m_tree.filterParameters().minOccupancy;
  filter.maxProbability = m_tree.filterParameters().maxProbability;
  filter.softLabelFloor = m_tree.filterParameters().softLabelFloor;
  likelihoodOptions = likelihood;
  renderingOptions = rendering;
  auxParticleFilterCleanUp();
  m_lastInsertion = {};
  m_observationClock = ObservationClock();
}

}  // namespace semantic_map
