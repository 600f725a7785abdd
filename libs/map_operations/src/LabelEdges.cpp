#include "LabelEdges.h"

#include <semantic_octree/store/CalibrationFit.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace semantic_octree {
namespace {

/** Labels of a voxel, one of which may differ from the others. */
constexpr std::size_t kFewest = 3;
/** Voxels are beside each other up to so many voxels apart, along each axis. */
constexpr std::uint64_t kBeside = 3;
/** Two classes that truly lie beside each other have edges in all scans, too. So the pairs that
 * tell most are left out, and no other one counts more than so many times what all do. */
constexpr std::size_t kPairsLeftOut = 3;
constexpr double kMostOfPair = 5;
constexpr int kHalvingsOfShare = 12;

/** A voxel whose labels, but at most one, are the same. */
struct Place {
  std::uint64_t voxel;
  const std::string* labels;
  char label;
  std::size_t exception;  ///< which label differs; their number if none
  double right;           ///< probability of the label
  bool differs() const { return exception < labels->size(); }
};

bool agree(const std::string& labels, Place& place) {
  if (labels.size() < kFewest) return false;
  place.label = labels[0] == labels[1] ? labels[0] : labels[2];
  const auto other = [&place](char label) { return label != place.label; };
  const auto differs = std::find_if(labels.begin(), labels.end(), other);
  place.exception = static_cast<std::size_t>(differs - labels.begin());
  return differs == labels.end() || std::none_of(differs + 1, labels.end(), other);
}

/** How often two classes lie beside each other. */
struct Edges {
  double always = 0, once = 0;
  double alike = 0;  ///< voxels that one scan mistakes alike, less what two scans do by chance
};
using EdgesOfPairs = std::map<std::pair<unsigned char, unsigned char>, Edges>;

/** Scan by scan, where the other scans are of one mind. Voxels of as many labels were seen by the
 * same scans, nearly always. */
void count(const Place& a, const Place& b, EdgesOfPairs& edges) {
  const std::size_t n = a.labels->size();
  if (b.labels->size() != n) return;
  const std::size_t i = std::min(a.exception, b.exception);
  const auto ofPair = [&edges](unsigned char x, unsigned char y) -> Edges& {
    return edges[{std::min(x, y), std::max(x, y)}];
  };
  if (a.differs() && b.differs()) {
    const char wrong = (*a.labels)[a.exception];
    if (a.label == b.label && wrong == (*b.labels)[b.exception])
      ofPair(a.label, wrong).alike +=
          a.exception == b.exception ? 1 : -1 / (static_cast<double>(n) - 1);
  } else if (a.label != b.label)
    ofPair(a.label, b.label).always += (i < n ? 1 : static_cast<double>(n)) * a.right * b.right;
  else if (i < n)
    ++ofPair((*a.labels)[i], (*b.labels)[i]).once;
}

EdgesOfPairs edgesOf(const std::vector<Place>& places) {
  EdgesOfPairs edges;
  for (const Place& place : places)
    for (std::uint64_t x = 0; x <= kBeside; ++x)
      for (std::uint64_t y = 0; y <= 2 * kBeside; ++y) {
        const std::uint64_t middle = place.voxel + (x << 32) + (y << 16) - (kBeside << 16);
        auto beside = std::lower_bound(
            places.begin(), places.end(), std::max(middle - kBeside, place.voxel + 1),
            [](const Place& other, std::uint64_t voxel) { return other.voxel < voxel; });
        for (; beside != places.end() && beside->voxel <= middle + kBeside; ++beside)
          count(place, *beside, edges);
      }
  return edges;
}

}  // namespace

double alwaysWrong(const PlacedLabels& voxels,
                   const std::function<std::vector<double>(const std::string&)>& classesOf) {
  std::vector<Place> places;
  for (const auto& [voxel, labels] : voxels) {
    Place place{voxel, &labels, 0, 0, 0};
    if (!agree(labels, place)) continue;
    place.right = classesOf(labels)[static_cast<unsigned char>(place.label) - std::size_t{1}];
    places.push_back(place);
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.voxel < b.voxel; });
  EdgesOfPairs edges = edgesOf(places);
  Edges all;
  for (const auto& [classes, seen] : edges) {
    all.once += seen.once;
    all.alike += seen.alike;
  }
  // At a straight edge half of the voxels beside one are like it. If those beside a wrong one are
  // not, scans err voxel by voxel, and no edge in all scans is that of a wrong place.
  const double patches = all.alike > 0 ? std::min(1.0, 2 * all.alike / (all.once + all.alike)) : 0;
  for (auto& [classes, seen] : edges) seen.always *= patches;
  return shareWithoutGain(kHalvingsOfShare, [&edges](double share) {
    std::vector<double> gains(kPairsLeftOut);
    for (const auto& [classes, seen] : edges)
      gains.push_back(std::min(seen.always, kMostOfPair * share * seen.once) - share * seen.once);
    std::sort(gains.begin(), gains.end());
    return std::accumulate(gains.begin(), gains.end() - kPairsLeftOut, 0.0);
  });
}

}  // namespace semantic_octree
