#include "Figures.h"
#include "figures/FigureScript.h"

namespace semantic_map_compress {

using namespace figures;

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
