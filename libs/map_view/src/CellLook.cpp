#include <map_view/CellSource.h>
#include <map_view/LiveCompression.h>
#include <semantic_types/ClassTable.h>
#include <tree_abstraction/Information.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace map_view {

using semantic_types::trafficLight;
using tree_abstraction::relativeEntropy;

namespace {

constexpr Color kFree{120, 180, 235}, kUnknown{60, 55, 50};

std::uint8_t byteOf(double x) { return static_cast<std::uint8_t>(x + 0.5); }

/** From dark violet (0) over blue and green to yellow (1), brighter and brighter. */
Color ramp(double value) {
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double at = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(at), kStops.size() - 2);
  const auto mixed = [&](std::size_t c) {
    return byteOf(kStops[i][c] + (at - double(i)) * (kStops[i + 1][c] - kStops[i][c]));
  };
  return {mixed(0), mixed(1), mixed(2)};
}

}  // namespace

const strict_files::Choices<ViewColoring>& choicesOf(ViewColoring) {
  static const strict_files::Choices<ViewColoring> choices = {
      {"class", ViewColoring::Class},     {"probability", ViewColoring::Probability},
      {"entropy", ViewColoring::Entropy}, {"occupancy", ViewColoring::Occupancy},
      {"height", ViewColoring::Height},   {"retained", ViewColoring::Retained}};
  return choices;
}

bool ViewStyle::hidesClasses() const {
  return std::find(hiddenClasses.begin(), hiddenClasses.end(), true) != hiddenClasses.end();
}

CellLook::CellLook(const SemanticOcTree& map) : m_map(map) { forget(); }

void CellLook::forget() {
  m_inner.clear();
  Eigen::Vector3d low, high;
  m_map.getMetricMin(low.x(), low.y(), low.z());
  m_map.getMetricMax(high.x(), high.y(), high.z());
  m_known = {low, high};
}

bool CellLook::isShown(const ViewCell& cell) const {
  const Eigen::Vector3d center = cell.center(m_map.getResolution());
  if (!m_style.clip.contains(center)) return false;
  if (!cell.node) return m_style.unknownSpace && m_known.contains(center);
  if (!cell.isOccupied()) return m_style.freeSpace;
  const ClassId id = m_style.hidesClasses() ? classOf(cell) : ClassId(0);
  return !m_style.hidesClasses() || id >= m_style.hiddenClasses.size() ||
         !m_style.hiddenClasses[id];
}

KeyBox CellLook::bounds() const {
  const Eigen::AlignedBox3d box = m_known.intersection(m_style.clip);
  // What is known ends at borders of voxels, up to rounding.
  constexpr double kRounding = 1e-6;
  const auto voxels = [this](const Eigen::Vector3d& place) {
    return (place.array() / m_map.getResolution() - 0.5 + semantic_octree::kKeyOfOrigin).eval();
  };
  return {(voxels(box.min()) - kRounding).ceil().cast<int>(),
          (voxels(box.max()) + kRounding).floor().cast<int>()};
}

Color CellLook::heightColor(const ViewCell& cell) const {
  const double low = std::max(m_known.min().z(), m_style.clip.min().z()),
               high = std::min(m_known.max().z(), m_style.clip.max().z());
  return ramp((cell.center(m_map.getResolution()).z() - low) / std::max(high - low, 1e-6));
}

Color CellLook::colorOf(const ViewCell& cell) const {
  if (!cell.node) return kUnknown;
  if (!cell.isOccupied()) return kFree;
  switch (m_style.coloring) {
    case ViewColoring::Probability:
      return trafficLight(stateOf(cell).probability);
    case ViewColoring::Entropy:
      return trafficLight(1 - relativeEntropy(m_map.distribution(cell.node)));
    case ViewColoring::Occupancy:
      return trafficLight(2 * cell.node.getOccupancy() - 1);
    case ViewColoring::Height:
      return heightColor(cell);
    case ViewColoring::Retained:
      return trafficLight(m_compression ? m_compression->retainedAround(cell.around) : 1);
    case ViewColoring::Class:
      break;
  }
  return semantic_types::colorOf(classOf(cell), m_map.classes());
}

CellLook::State CellLook::newState(const ViewCell& cell) const {
  const semantic_octree::CellState state = m_map.query(cell.node);
  return {state.likeliestClass, static_cast<float>(state.probability)};
}

/** Inner nodes take a look at all leaves below them. */
CellLook::State CellLook::stateOf(const ViewCell& cell) const {
  if (cell.innerNode == 0) return newState(cell);
  const auto known = m_inner.find(cell.innerNode);
  if (known != m_inner.end()) return known->second;
  return m_inner.emplace(cell.innerNode, newState(cell)).first->second;
}

}  // namespace map_view
