#include "Figures.h"
#include "figures/FigureScript.h"

namespace semantic_map_evaluate {

using namespace figures;

namespace {

/** Bins of fewer points than this share of all are not drawn: their share is chance. */
constexpr double kLeast = 2e-4;

/** Data of a map: stated and right, percent, and the share of the points, percent. */
void writeData(std::ostream& out, const NamedEvaluation& map, std::size_t i) {
  out << "$map" << i << " << EOD\n";
  const auto all = static_cast<double>(map.evaluation.answered());
  for (const Evaluation::Bin& bin : map.evaluation.reliability())
    if (const auto points = static_cast<double>(bin.points); points > kLeast * all)
      out << 100 * bin.meanStated() << ' ' << 100 * bin.shareRight() << ' ' << 100 * points / all
          << '\n';
  out << "EOD\n";
}

/** A line for each map. \param columns of the data \param titled whether they are in the key */
std::string linesOf(const std::vector<NamedEvaluation>& maps, const std::string& columns,
                    bool titled) {
  std::string plots;
  for (std::size_t i = 0; i < maps.size(); ++i)
    plots += ", $map" + std::to_string(i) + " using " + columns + " with linespoints lw 2 ps 0.8 " +
             styleOf(i) + ' ' + (titled ? "title " + gnuplotText(maps[i].name) : "notitle");
  return plots;
}

}  // namespace

void drawReliability(const std::vector<NamedEvaluation>& maps, const std::filesystem::path& file) {
  auto out = scriptFor(760, 820);
  for (std::size_t i = 0; i < maps.size(); ++i) writeData(out, maps[i], i);
  out << "set multiplot\nset lmargin 10; set rmargin 3\nset xrange [0:100]\n"
      << "set tmargin at screen 0.97; set bmargin at screen 0.36\n"
      << "set ylabel 'points that are right [%]'\nset yrange [0:100]\n"
      << "set key right bottom samplen 2\nset format x ''\n"
      << "plot x with lines dt 2 lc rgb '#808080' title 'as stated'" << linesOf(maps, "1:2", true)
      << "\nset tmargin at screen 0.31; set bmargin at screen 0.08\nset format x\n"
      << "set xlabel 'stated probability of the class, where occupied [%]'\n"
      << "set ylabel 'share of the points [%]'\nset yrange [0.02:100]\nset logscale y\n"
      << "plot NaN notitle" << linesOf(maps, "1:3", false) << "\nunset multiplot\n";
  drawWithGnuplot(out.str(), file);
}

}  // namespace semantic_map_evaluate
