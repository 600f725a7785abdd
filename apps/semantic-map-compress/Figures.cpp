#include "Figures.h"

#include <algorithm>

#include "figures/FigureScript.h"

namespace semantic_map_compress {

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

void plotRetainedBars(std::ostream& out, const std::vector<Compression>& compressions,
                      const std::vector<std::size_t>& classes) {
  const double width = 0.82 / static_cast<double>(compressions.size());
  for (std::size_t s = 0; s < compressions.size(); ++s) {
    out << "$retained" << s << " << EOD\n";
    for (std::size_t i = 0; i < classes.size(); ++i)
      out << static_cast<double>(i) - 0.41 + width * (static_cast<double>(s) + 0.5) << ' '
          << 100 * compressions[s].kept[classes[i]].share.value_or(0) << '\n';
    out << "EOD\n";
  }
  out << "plot ";
  for (std::size_t s = 0; s < compressions.size(); ++s)
    out << (s ? ", " : "") << "$retained" << s << " using 1:2:(" << width
        << ") with boxes fs solid 1 noborder lc rgb '" << colorOf(s) << "' title "
        << gnuplotText(compressions[s].solution.name);
  out << '\n';
}

void plotLeafRatios(std::ostream& out, const std::vector<Compression>& compressions) {
  double highest = 0;
  for (std::size_t s = 0; s < compressions.size(); ++s) {
    const double percent = 100 * compressions[s].leafRatio();
    highest = std::max(highest, percent);
    char label[80];
    std::snprintf(label, sizeof label, "%.3g %%  (%zu)", percent,
                  compressions[s].measures.compressed.numKnownLeaves);
    out << "$leaves" << s << " << EOD\n" << s << ' ' << percent << " \"" << label << "\"\nEOD\n";
  }
  out << "set yrange [0:" << std::max(1e-3, 1.3 * highest) << "]\nplot ";
  for (std::size_t s = 0; s < compressions.size(); ++s)
    out << (s ? ", " : "") << "$leaves" << s << " using 1:2:(0.5) with boxes fs solid 1 noborder"
        << " lc rgb '" << colorOf(s) << "' notitle, $leaves" << s
        << " using 1:2:3 with labels offset 0,0.8 notitle";
  out << '\n';
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
  const std::string color = std::string(" lc rgb '") + colorOf(solution) + "'";
  return name + " with lines lw " + (relevant ? "2.5" : "1") + " dt " + dashOf(solution) + color +
         " title " + gnuplotText(c.solution.name + (relevant ? "" : ", irrelevant")) + ", " + name +
         "chosen with points pt 7 ps 1.4" + color + " notitle, ";
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

}  // namespace semantic_map_compress
