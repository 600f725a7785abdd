#include "StudyFigures.h"

#include <algorithm>
#include <cmath>

#include "Study.h"
#include "figures/FigureScript.h"

namespace planning_study {

using nlohmann::ordered_json;
using namespace figures;

namespace {

constexpr std::size_t kColumnWidth = 420, kRowHeight = 320, kKeyHeight = 40;  // pixels
constexpr double kBox = 0.15;  // width; budgets stand at 0, 1, 2...

/** One line for all plots, below them; the first plot draws it. */
void writeKey(std::ostream& out, const ordered_json& graphs) {
  constexpr double kHeight = 0.035, kHalfLine = 0.022;  // of the sheet
  out << "unset key\n";
  for (std::size_t g = 0; g < graphs.size(); ++g) {
    const double x = (static_cast<double>(g) + 0.3) / static_cast<double>(graphs.size());
    const std::string style = " lc rgb '" + std::string(colorOf(g)) + "'";
    out << "set arrow from screen " << x - kHalfLine << ',' << kHeight << " to screen "
        << x + kHalfLine << ',' << kHeight << " nohead lw 2 dt " << dashOf(g) << style << '\n'
        << "set label " << gnuplotText(graphs[g]) << " at screen " << x << ',' << kHeight
        << " point pt " << pointOf(g) << " ps 1.5" << style << " offset 3.5,0\n";
  }
}

const char* const kKeyIsDrawn = "unset label\nunset arrow\n";

std::ostringstream sheetFor(const ordered_json& study, std::size_t rows) {
  const auto maps = static_cast<double>(study["maps"].size());
  const std::size_t height = rows * kRowHeight + kKeyHeight;
  const auto share = [&](std::size_t pixels) {
    return static_cast<double>(pixels) / static_cast<double>(height);
  };
  auto out = scriptFor(study["maps"].size() * kColumnWidth, height);
  const auto& budgets = study["options"]["budgets"];
  out << "set multiplot layout " << rows << ',' << maps << " columnsfirst margins " << 0.17 / maps
      << ",0.99," << share(kKeyHeight + 50) << ',' << 1 - share(40) << " spacing " << 0.17 / maps
      << ',' << share(45) << "\nset xtics "
      << tics(budgets.size(), [&](std::size_t i) { return budgets[i].dump(); })
      << "\nset xrange [-0.5:" << static_cast<double>(budgets.size()) - 0.5 << "]\n";
  writeKey(out, study["options"]["graphs"]);
  return out;
}

/** The way with the judgment "profile"; null if there is none. */
ordered_json wayOf(const ordered_json& map, const std::string& graph, const ordered_json& budget,
                   const std::string& memory) {
  for (const ordered_json& way : map["ways"])
    if (way["judgment"] == "profile" && way["graph"] == graph && way["budget"] == budget &&
        way["memory"] == memory)
      return way;
  return nullptr;
}

/** One curve or row of boxes for each graph. */
class Plot {
 public:
  /** \param memory "cold" or "kept" */
  Plot(const ordered_json& study, const ordered_json& map, std::string memory = "cold")
      : m_study(study), m_map(map), m_memory(std::move(memory)) {}

  /** values(way) gives what stands after the abscissa in a line of data. */
  template <class Values>
  void write(std::ostream& out, const Values& values) const {
    const auto& graphs = m_study["options"]["graphs"];
    for (std::size_t g = 0; g < graphs.size(); ++g) {
      out << "$g" << g << " << EOD\n";
      const auto& budgets = m_study["options"]["budgets"];
      for (std::size_t b = 0; b < budgets.size(); ++b) {
        const ordered_json way = wayOf(m_map, graphs[g], budgets[b], m_memory);
        if (way.is_null() || way["found"] == 0) continue;
        out << static_cast<double>(b) + offset(g) << ' ' << values(way) << '\n';
      }
      out << "0 NaN NaN NaN NaN NaN\nEOD\n";
    }
  }

  /** "plot" with these styles. \param look of a graph in all of them */
  void plot(std::ostream& out, const std::vector<std::string>& styles,
            std::string (*look)(std::size_t)) const {
    const auto& graphs = m_study["options"]["graphs"];
    out << "$dot << EOD\n0 1\nEOD\nplot ";  // gnuplot refuses axes without a valid point
    for (std::size_t g = 0; g < graphs.size(); ++g)
      for (const std::string& style : styles)
        out << "$g" << g << ' ' << style << ' ' << look(g) << ", ";
    out << "$dot with dots lc rgb '#ffffff'\n";
  }

 private:
  double offset(std::size_t graph) const {
    return (static_cast<double>(graph) -
            (static_cast<double>(m_study["options"]["graphs"].size()) - 1) / 2) *
           kBox;
  }

  const ordered_json& m_study;
  const ordered_json& m_map;
  const std::string m_memory;
};

std::string box(const ordered_json& d) {
  std::ostringstream out;
  for (const char* part : {"quartile1", "percentile5", "percentile95", "quartile3", "median"})
    out << d[part].get<double>() << ' ';
  return out.str();
}

/** Boxes have no dashes. */
std::string boxOf(std::size_t graph) { return std::string("lc rgb '") + colorOf(graph) + "'"; }

std::string valueWithInterval(const ordered_json& estimate) {
  std::ostringstream out;
  out << 100 * estimate["value"].get<double>() << ' ' << 100 * estimate["low"].get<double>() << ' '
      << 100 * estimate["high"].get<double>();
  return out.str();
}

void label(std::ostream& out, bool first, const std::string& text) {
  if (first)
    out << "set ylabel " << gnuplotText(text) << " offset 0,0\n";
  else
    out << "unset ylabel\n";
}

/** One range for all plots: from the least whisker to the largest. */
std::string rangeOfTimes(const ordered_json& study) {
  double low = 1e9, high = 0;
  for (const ordered_json& map : study["maps"])
    for (const ordered_json& way : map["ways"]) {
      if (way["judgment"] != "profile" || way["graph"] == kReference || way["found"] == 0) continue;
      low = std::min(low, way["milliseconds"]["planning"]["percentile5"].get<double>());
      high = std::max(high, way["milliseconds"]["planning"]["percentile95"].get<double>());
    }
  std::ostringstream out;
  if (high > 0) out << "set yrange [" << 0.9 * low << ':' << 1.1 * high << "]\n";
  return out.str();
}

/** One range for all plots, and where something is: near 100 %, curves hide each other. */
std::string rangeOfShares(const ordered_json& study) {
  double low = 1;
  for (const ordered_json& map : study["maps"])
    for (const ordered_json& way : map["ways"])
      if (way["judgment"] == "profile" && way["memory"] == "cold" && way["graph"] != kReference)
        low = std::min(low, way["success"]["low"].get<double>());
  std::ostringstream out;
  out << '[' << 10 * std::floor(10 * std::min(low, 0.9)) << ":101]";
  return out.str();
}

}  // namespace

void drawTimes(const ordered_json& study, const std::filesystem::path& file) {
  auto out = sheetFor(study, 2);
  out << "set logscale y\nset format y '%g'\nset boxwidth " << 0.85 * kBox
      << "\nset style fill solid 0.35\n"
      << rangeOfTimes(study);
  bool first = true;
  for (const ordered_json& map : study["maps"]) {
    out << "set title " << gnuplotText(map["name"]) << "\nunset xlabel\n";
    for (const std::string memory : {"cold", "kept"}) {
      label(out, first, memory + ": planning time [ms]");
      const Plot plot(study, map, memory);
      plot.write(out, [](const ordered_json& way) { return box(way["milliseconds"]["planning"]); });
      plot.plot(out,
                {"using 1:2:3:4:5 with candlesticks whiskerbars 0.5",
                 "using 1:6:6:6:6 with candlesticks lw 2"},
                boxOf);
      out << kKeyIsDrawn << "unset title\nset xlabel 'vertices'\n";
    }
    first = false;
  }
  out << "unset multiplot\n";
  drawWithGnuplot(out.str(), file);
}

void drawPaths(const ordered_json& study, const std::filesystem::path& file) {
  auto out = sheetFor(study, 2);
  const std::string shares = rangeOfShares(study);
  bool first = true;
  for (const ordered_json& map : study["maps"]) {
    const Plot plot(study, map);
    out << "set title " << gnuplotText(map["name"]) << "\nset yrange " << shares
        << "\nunset xlabel\n";
    label(out, first, "tasks solved [%]");
    plot.write(out, [](const ordered_json& way) { return valueWithInterval(way["success"]); });
    plot.plot(out, {"using 1:2 with linespoints lw 2", "using 1:2:3:4 with yerrorbars ps 1.3"},
              styleOf);
    out << kKeyIsDrawn << "unset title\nset autoscale y\nset yrange [0:*]\nset xlabel 'vertices'\n";
    label(out, first, "outside the best rank [m]");
    plot.write(out, [](const ordered_json& way) { return box(way["metersOutsideBest"]); });
    plot.plot(out, {"using 1:6 with linespoints lw 2", "using 1:6:2:5 with yerrorbars ps 1.3"},
              styleOf);
    first = false;
  }
  out << "unset multiplot\n";
  drawWithGnuplot(out.str(), file);
}

}  // namespace planning_study
