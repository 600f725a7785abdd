#include <labeled_cloud/Rawlogs.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/MapFiles.h>
#include <semantic_types/ClassTable.h>
#include <strict_files/TextFile.h>

#include <iomanip>
#include <ostream>
#include <stdexcept>

namespace semantic_map {

using semantic_octree::CellState;
using semantic_octree::SemanticOcTree;
using semantic_types::ClassId;
using semantic_types::ClassTable;

namespace {

/** Calls action(leaf). */
template <class Action>
void forEachPoint(const SemanticOcTree& tree, bool free, Action action) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
    if (free || leaf->getLogOdds() > 0) action(leaf);
}

template <typename... Values>
void writeBytes(std::ostream& out, const Values&... values) {
  (out.write(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
}

void writePlyHeader(std::ostream& out, const ClassTable& classes, std::size_t points) {
  const strict_files::ClassicNumbers classic(out);
  out << "ply\nformat binary_little_endian 1.0\n";
  for (int id = 1; id <= classes.size(); ++id)
    out << "comment class " << id << " " << classes.name(static_cast<ClassId>(id)) << "\n";
  out << "element vertex " << points << "\n";
  for (const char* property :
       {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue", "uchar class",
        "float probability", "float occupancy", "float size"})
    out << "property " << property << "\n";
  out << "end_header\n";
}

void checked(const std::ostream& out) {
  if (!out) throw std::runtime_error("cannot write the points");
}

}  // namespace

void writePly(std::ostream& out, const SemanticOcTree& tree, bool free) {
  std::size_t points = 0;
  forEachPoint(tree, free, [&points](const auto&) { ++points; });
  writePlyHeader(out, tree.classes(), points);
  forEachPoint(tree, free, [&](const auto& leaf) {
    const CellState state = tree.query(*leaf);
    const auto color = colorOf(state.likeliestClass, tree.classes());
    writeBytes(out, float(leaf.getX()), float(leaf.getY()), float(leaf.getZ()), color.r, color.g,
               color.b, state.likeliestClass, float(state.probability), float(state.occupancy),
               float(leaf.getSize()));
  });
  checked(out);
}

void writeCsv(std::ostream& out, const SemanticOcTree& tree, bool free) {
  const strict_files::ClassicNumbers classic(out);
  out << "x,y,z,size,occupancy,class,name,probability\n" << std::setprecision(7);
  forEachPoint(tree, free, [&](const auto& leaf) {
    const CellState state = tree.query(*leaf);
    const ClassId id = state.likeliestClass;
    out << leaf.getX() << ',' << leaf.getY() << ',' << leaf.getZ() << ',' << leaf.getSize() << ','
        << state.occupancy << ',' << int{id} << ','
        << (id == semantic_types::kNoClass ? "" : strict_files::csvField(tree.classes().name(id)))
        << ',' << state.probability << '\n';
  });
  checked(out);
}

void writeScene(const mrpt_compat::Scene& scene, const std::filesystem::path& file) {
  labeled_cloud::GzipArchive archive(file);
  archive << scene;
  archive.close();
}

}  // namespace semantic_map
