#include "Report.h"

#include <mrpt/core/format.h>
#include <strict_files/TextFile.h>
#include <tree_abstraction/Information.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "Application.h"
#include "figures/FigureScript.h"

namespace semantic_map_compress {

using map_pictures::bgr;
using map_pictures::kPaper;
using map_pictures::MapCanvas;
using semantic_octree::SemanticOcTree;

namespace {

constexpr int kSheetWidth = 2100;

cv::Mat onPaper(const cv::Mat& picture, cv::Size size) {
  cv::Mat paper(size, CV_8UC3, bgr(kPaper));
  const cv::Point corner((size.width - picture.cols) / 2, (size.height - picture.rows) / 2);
  picture.copyTo(paper(cv::Rect(corner, picture.size())));
  return paper;
}

}  // namespace

MapSheet::MapSheet(std::size_t numMaps)
    : m_columns(std::max(1, static_cast<int>(std::ceil(std::sqrt(double(numMaps)))))) {
  const int width = std::max(240, std::min(900, kSheetWidth / m_columns));
  m_tile = {width, width * 3 / 4};
}

void MapSheet::add(const SemanticOcTree& map, const std::string& title) {
  map_pictures::PictureStyle style;
  style.width = m_tile.width, style.height = m_tile.height;
  auto canvas = m_first ? m_first->blank() : MapCanvas::ofMap(map, style);
  if (m_first) canvas.drawMap(map, style);
  for (const auto& entry : canvas.legend()) explain(entry);
  cv::Mat picture = canvas.picture().clone();
  map_pictures::drawScaleBar(picture, canvas.pixelsPerMeter());
  if (!m_first) m_first = std::move(canvas);
  m_tiles.push_back(map_pictures::withTitle(onPaper(picture, m_tile), title));
}

void MapSheet::explain(const map_pictures::LegendEntry& entry) {
  const auto hasName = [&entry](const auto& other) { return other.name == entry.name; };
  if (std::none_of(m_legend.begin(), m_legend.end(), hasName)) m_legend.push_back(entry);
}

cv::Mat MapSheet::picture() const {
  std::vector<cv::Mat> rows;
  const int numTiles = static_cast<int>(m_tiles.size());
  for (int first = 0; first < numTiles; first += m_columns) {
    std::vector<cv::Mat> row(m_tiles.begin() + first,
                             m_tiles.begin() + std::min(first + m_columns, numTiles));
    while (static_cast<int>(row.size()) < m_columns && first > 0)
      row.emplace_back(m_tiles.front().size(), CV_8UC3, bgr(kPaper));
    cv::hconcat(row, rows.emplace_back());
  }
  cv::Mat maps;
  cv::vconcat(rows, maps);
  return withLegend(maps, "", m_legend);
}

using namespace figures;

namespace {

/** Free space and the classes that some voxel has: in the others' little information is only how
 * unlikely they are. */
std::vector<std::size_t> presentClasses(const FullMap& map) {
  std::vector<std::size_t> present = {0};
  for (std::size_t id = 1; id < map.voxelsOfClass.size(); ++id)
    if (map.voxelsOfClass[id] > 0) present.push_back(id);
  return present;
}

/** A row a class, a column a solution. */
void plotRetainedBars(std::ostream& out, const std::vector<Compression>& compressions,
                      const std::vector<std::size_t>& classes) {
  out << "$retained << EOD\n";
  for (const std::size_t id : classes) {
    for (const Compression& c : compressions) out << 100 * c.kept[id].share.value_or(0) << ' ';
    out << '\n';
  }
  out << "EOD\nset style histogram clustered gap 1\nset style fill solid 1 noborder\nplot ";
  for (std::size_t s = 0; s < compressions.size(); ++s)
    out << (s ? ", " : "") << "$retained using " << s + 1 << " with histograms" << styleOf(s)
        << " title " << gnuplotText(compressions[s].solution.name);
  out << '\n';
}

void plotLeafRatios(std::ostream& out, const std::vector<Compression>& compressions) {
  double highest = 0;
  out << "$leaves << EOD\n";
  for (std::size_t s = 0; s < compressions.size(); ++s) {
    const double percent = 100 * compressions[s].leafRatio();
    highest = std::max(highest, percent);
    out << s << ' ' << percent << ' ' << s + 1
        << mrpt::format(" \"%.3g %%  (%zu)\"\n", percent,
                        compressions[s].measures.compressed.numKnownLeaves);
  }
  out << "EOD\nset yrange [0:" << std::max(1e-3, 1.3 * highest) << "]\n"
      << "plot $leaves using 1:2:(0.5):3 with boxes fs solid 1 noborder lc variable notitle, "
         "$leaves using 1:2:4 with labels offset 0,0.8 notitle\n";
}

}  // namespace

void drawRetained(const FullMap& map, const std::vector<Compression>& compressions,
                  const TermCatalog& catalog, const std::filesystem::path& file) {
  const auto classes = presentClasses(map);
  const std::size_t bars = classes.size() * (compressions.size() + 1);
  auto out = scriptFor(std::clamp<std::size_t>(120 + 9 * bars, 1000, 4000), 760);
  out << "set multiplot\nset lmargin 10; set rmargin 2\n"
      << "set tmargin at screen 0.92; set bmargin at screen 0.48\n"
      << "set key at screen 0.5, screen 0.965 center maxrows 1 samplen 1 width 2 Left reverse\n"
      << "set ylabel 'information retained [%]'\nset yrange [0:100]\n"
      << "set xrange [-0.6:" << static_cast<double>(classes.size()) - 0.4 << "]\n"
      << "set xtics rotate by 38 right scale 0 "
      << tics(classes.size(), [&](std::size_t i) { return catalog.name(classes[i]); }) << '\n';
  plotRetainedBars(out, compressions, classes);
  out << "unset key\nset tmargin at screen 0.33; set bmargin at screen 0.06\n"
      << "set ylabel 'leaves left [%]'\n"
      << "set xrange [-0.6:" << static_cast<double>(compressions.size()) - 0.4 << "]\n"
      << "unset xtics\nset xtics norotate center scale 0 textcolor rgb '#303030' "
      << tics(compressions.size(), [&](std::size_t s) { return compressions[s].solution.name; })
      << '\n';
  plotLeafRatios(out, compressions);
  out << "unset multiplot\n";
  drawWithGnuplot(out.str(), file);
}

namespace {

using Share = std::optional<double> CurvePoint::*;

/** Writes a curve's data. \return what plots it, and the point that was chosen */
std::string plotCurve(std::ostream& out, const Compression& c, Share share, std::size_t solution,
                      bool relevant) {
  if (!(c.curve.front().*share)) return {};
  const std::string name = (relevant ? "$relevant" : "$irrelevant") + std::to_string(solution);
  out << name << " << EOD\n";
  for (const CurvePoint& p : c.curve) out << p.leaves << ' ' << 100 * *(p.*share) << '\n';
  out << "EOD\n" << name << "chosen << EOD\n";
  out << c.chosen.leaves << ' ' << 100 * *(c.chosen.*share) << "\nEOD\n";
  return name + " with lines" + styleOf(solution) + " lw " + (relevant ? "2.5" : "1") + " title " +
         gnuplotText(c.solution.name + (relevant ? "" : ", irrelevant")) + ", " + name +
         "chosen with points" + styleOf(solution) + " pt 7 ps 1.4 notitle, ";
}

}  // namespace

void drawCurves(const std::vector<Compression>& compressions, const std::filesystem::path& file) {
  auto out = scriptFor(1000, 600);
  out << "set logscale x\nset format x '%.0s %c'\nset xlabel 'known leaves'\n"
      << "set ylabel 'information retained [%]'\nset yrange [0:103]\n"
      << "set key outside right top samplen 2 spacing 1.25 Left reverse\n";
  std::string plots;
  for (std::size_t s = 0; s < compressions.size(); ++s)
    for (const bool relevant : {true, false}) {
      const auto share = relevant ? &CurvePoint::relevant : &CurvePoint::irrelevant;
      plots += plotCurve(out, compressions[s], share, s, relevant);
    }
  out << "plot " << plots << "NaN notitle\n";
  drawWithGnuplot(out.str(), file);
}

using nlohmann::ordered_json;
using strict_files::csvField;
using tree_abstraction::natsToBits;
using tree_abstraction::TreeMeasures;

namespace {

ordered_json orNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json toJson(const TreeMeasures& tree) {
  return {{"knownLeaves", tree.numKnownLeaves},
          {"allLeaves", tree.numLeaves},
          {"leafEntropy", natsToBits(tree.leafEntropy)}};
}

/** What a solution has in common with all others. */
ordered_json spaceJson(AbstractionOptions solution) {
  strict_files::OptionList options;
  solution.describe(options);
  for (const char* name : {"relevant", "irrelevant", "everything", "alpha", "regions"})
    options.remove(name);
  ordered_json json = jsonOf(options);
  json["regions"] = solution.regions.size();
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
  for (const auto& term : c.solution.weights.terms) weights[term.name] = term.weight;
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
          {"milliseconds", c.times.stages()}};
}

}  // namespace

ordered_json toJson(const FullMap& map, const TermCatalog& catalog,
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
          {"space", spaceJson(compressions.front().solution)},
          {"solutions", solutions},
          {"milliseconds", times.stages()}};
}

std::string toCsv(const ordered_json& report) {
  std::string text;
  for (ordered_json solution : report["solutions"]) {
    for (const char* list : {"weights", "curve"}) solution.erase(list);
    if (solution["groups"].empty()) solution.erase("groups");
    solution["full"] = report["map"]["tree"];
    const ordered_json flat = solution.flatten();
    std::string header, line;
    for (const auto& [name, value] : flat.items()) {
      const std::string before = header.empty() ? "" : ",";
      header += before + csvField(name);
      line += before + (value.is_string() ? csvField(value) : value.is_null() ? "" : value.dump());
    }
    text += (text.empty() ? header + '\n' : "") + line + '\n';
  }
  return text;
}

}  // namespace semantic_map_compress
