#include <mrpt/img/TColor.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_abstraction/Abstraction.h>
#include <semantic_map/CSemanticOctoMap.h>
#include <semantic_map/MapFiles.h>
#include <semantic_map/MapOptions.h>
#include <semantic_octree/SemanticOcTree.h>
#include <semantic_octree/TreeFile.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/OutputFiles.h>
#include <tree_abstraction/Information.h>

namespace semantic_map {

using mrpt_compat::drawing::COctoMapVoxels;
using semantic_octree::Abstraction;
using semantic_octree::SemanticOcTree;
using semantic_types::trafficLight;
using tree_abstraction::relativeEntropy;

namespace {

mrpt::img::TColor mrptColor(const semantic_types::Color& c) { return {c.r, c.g, c.b}; }

mrpt::img::TColor colorOf(const SemanticOcTree& tree, const SemanticOcTree::Node& node,
                          TRenderingOptions::Coloring coloring) {
  if (coloring == TRenderingOptions::Coloring::Probability)
    return mrptColor(trafficLight(tree.query(node).probability));
  if (coloring == TRenderingOptions::Coloring::Entropy)
    return mrptColor(trafficLight(1 - relativeEntropy(tree.distribution(node))));
  return mrptColor(semantic_types::colorOf(tree.query(node).likeliestClass, tree.classes()));
}

}  // namespace

mrpt::math::TBoundingBoxf CSemanticOctoMap::boundingBox() const {
  const auto lock = reading();
  return knownBox();
}

mrpt::math::TBoundingBoxf CSemanticOctoMap::knownBox() const {
  double low[3] = {}, high[3] = {};
  m_tree.getMetricMin(low[0], low[1], low[2]);
  m_tree.getMetricMax(high[0], high[1], high[2]);
  return {{float(low[0]), float(low[1]), float(low[2])},
          {float(high[0]), float(high[1]), float(high[2])}};
}

void CSemanticOctoMap::getVisualizationInto(mrpt_compat::drawing::CSetOfObjects& o) const {
  if (!genericMapParams.enableSaveAs3DObject || isEmpty()) return;
  const auto lock = reading();
  if (!renderingOptions.compressed || !hasAbstraction(m_tree)) return draw(m_tree, o);
  if (m_folder) return draw(Abstraction(const_cast<SemanticOcTree&>(m_tree)).compressedMap(), o);
  SemanticOcTree copy(m_tree);
  draw(Abstraction(copy).compressedMap(), o);
}

void CSemanticOctoMap::draw(const SemanticOcTree& tree,
                            mrpt_compat::drawing::CSetOfObjects& o) const {
  const TRenderingOptions& options = renderingOptions;
  const auto voxels = COctoMapVoxels::Create();
  voxels->resizeVoxelSets(2);
  voxels->setVisualizationMode(COctoMapVoxels::FIXED);
  voxels->enableLights(true);
  voxels->enableCubeTransparency(true);
  for (auto it = tree.begin_leafs(), end = tree.end_leafs(); it != end; ++it) {
    const bool occupied = tree.isNodeOccupied(*it);
    if (it.getZ() < options.minHeight || it.getZ() > options.maxHeight) continue;
    if (!occupied && !options.free) continue;
    const mrpt::math::TPoint3Df center(float(it.getX()), float(it.getY()), float(it.getZ()));
    const mrpt::img::TColor color =
        occupied ? colorOf(tree, *it, options.coloring) : mrpt::img::TColor(160, 200, 230, 25);
    voxels->push_back_Voxel(occupied ? mrpt_compat::drawing::VOXEL_SET_OCCUPIED
                                     : mrpt_compat::drawing::VOXEL_SET_FREESPACE,
                            {center, it.getSize(), color});
  }
  const auto box = knownBox();
  voxels->setBoundingBox(mrpt::math::TPoint3D(box.min), mrpt::math::TPoint3D(box.max));
  o.insert(voxels);
}

void CSemanticOctoMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
  if (m_folder) {  // what was opened to be read has nothing to save
    const auto lock = reading();
    return m_folder->readOnly ? void() : m_folder->tiles.save();
  }
  semantic_octree::saveTree(m_tree, prefix + ".semantic");
  strict_files::StagedFile file(prefix + ".3Dscene");
  mrpt_compat::Scene scene;
  const auto objects = mrpt_compat::drawing::CSetOfObjects::Create();
  getVisualizationInto(*objects);
  scene.insert(objects);
  writeScene(scene, file.path());
  file.commit();
}

}  // namespace semantic_map
