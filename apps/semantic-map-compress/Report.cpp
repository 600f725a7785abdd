#include "Report.h"

#include <strict_files/TextFile.h>
#include <tree_abstraction/Information.h>

#include <sstream>

#include "JsonFile.h"

namespace semantic_map_compress {

using nlohmann::ordered_json;
using semantic_octree::AbstractionOptions;
using strict_files::csvField;
using tree_abstraction::natsToBits;
using tree_abstraction::TreeMeasures;

namespace {

ordered_json orNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json toJson(const StageTimer& times) {
  ordered_json json = ordered_json::object();
  for (const auto& [stage, milliseconds] : times.stages()) json[stage] = milliseconds;
  return json;
}

ordered_json toJson(const TreeMeasures& tree) {
  return {{"knownLeaves", tree.numKnownLeaves},
          {"allLeaves", tree.numLeaves},
          {"leafEntropy", natsToBits(tree.leafEntropy)}};
}

ordered_json toJson(AbstractionOptions space) {
  strict_files::OptionList options;
  space.describe(options);
  ordered_json json = jsonOf(options);
  json["regions"] = space.regions.size();
  return json;
}

ordered_json informationJson(const TermCatalog& catalog, const std::vector<KeptInformation>& kept,
                             std::size_t begin, std::size_t end) {
  ordered_json json = ordered_json::object();
  for (std::size_t t = begin; t < end; ++t)
    json[catalog.name(t)] = {{"full", natsToBits(kept[t].full)},
                             {"kept", natsToBits(kept[t].kept)},
                             {"share", orNull(kept[t].share)}};
  return json;
}

ordered_json curveJson(const std::vector<CurvePoint>& curve) {
  ordered_json json = ordered_json::array();
  for (const CurvePoint& p : curve)
    json.push_back({{"alpha", p.alpha},
                    {"knownLeaves", p.leaves},
                    {"relevantShare", orNull(p.relevant)},
                    {"irrelevantShare", orNull(p.irrelevant)}});
  return json;
}

ordered_json toJson(const Compression& c, const TermCatalog& catalog) {
  ordered_json weights = ordered_json::object();
  for (const auto& term : c.solution.terms) weights[term.name] = term.weight;
  const std::size_t numClasses = catalog.numClasses() + 1;
  return {{"name", c.solution.name},
          {"weights", weights},
          {"alpha", c.alpha},
          {"tree", toJson(c.measures.compressed)},
          {"leafRatio", {{"known", c.leafRatio()}, {"all", c.allLeafRatio()}}},
          {"objective", natsToBits(c.measures.objective)},
          {"fileBytes", c.bytes},
          {"classes", informationJson(catalog, c.kept, 0, numClasses)},
          {"groups", informationJson(catalog, c.kept, numClasses, catalog.size())},
          {"curve", curveJson(c.curve)},
          {"milliseconds", toJson(c.times)}};
}

}  // namespace

ordered_json toJson(const FullMap& map, const TermCatalog& catalog, const AbstractionOptions& space,
                    const std::vector<Compression>& compressions, const StageTimer& times) {
  ordered_json voxels = ordered_json::object();
  for (std::size_t id = 1; id < map.voxelsOfClass.size(); ++id)
    voxels[catalog.name(id)] = map.voxelsOfClass[id];
  ordered_json solutions = ordered_json::array();
  for (const Compression& c : compressions) solutions.push_back(toJson(c, catalog));
  return {{"units", "informations, entropies and objectives in bits"},
          {"map",
           {{"file", map.file},
            {"resolution", map.resolution},
            {"nodes", map.nodes},
            {"fileBytes", map.bytes},
            {"voxelsPerClass", voxels},
            {"tree", toJson(compressions.front().measures.full)}}},
          {"space", toJson(space)},
          {"solutions", solutions},
          {"milliseconds", toJson(times)}};
}

std::string toCsv(const TermCatalog& catalog, const std::vector<Compression>& compressions) {
  std::ostringstream out;
  out.precision(10);
  out << "solution,alpha,known leaves,all leaves,full known leaves,full all leaves,leaf ratio,"
         "all leaf ratio,leaf entropy [bit],full leaf entropy [bit],objective [bit],file bytes";
  for (std::size_t t = 0; t < catalog.size(); ++t)
    out << ',' << csvField(catalog.name(t) + " [bit]") << ','
        << csvField(catalog.name(t) + " retained");
  for (const auto& [stage, milliseconds] : compressions.front().times.stages())
    out << ',' << csvField(stage + " [ms]");
  for (const Compression& c : compressions) {
    const auto& [full, kept] = std::tie(c.measures.full, c.measures.compressed);
    out << '\n'
        << csvField(c.solution.name) << ',' << c.alpha << ',' << kept.numKnownLeaves << ','
        << kept.numLeaves << ',' << full.numKnownLeaves << ',' << full.numLeaves << ','
        << c.leafRatio() << ',' << c.allLeafRatio() << ',' << natsToBits(kept.leafEntropy) << ','
        << natsToBits(full.leafEntropy) << ',' << natsToBits(c.measures.objective) << ','
        << c.bytes;
    for (const KeptInformation& k : c.kept) {
      out << ',' << natsToBits(k.full) << ',';
      if (k.share) out << *k.share;
    }
    for (const auto& [stage, milliseconds] : c.times.stages()) out << ',' << milliseconds;
  }
  out << '\n';
  return out.str();
}

}  // namespace semantic_map_compress
