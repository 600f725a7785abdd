#include <algorithm>
#include <array>
#include <cmath>

#include "Figures.h"
#include "figures/FigureScript.h"

namespace semantic_map_compress {

using namespace figures;

namespace {

/** Catalog indices of what some solution weighs. */
std::vector<std::size_t> weighedTerms(const std::vector<Compression>& compressions,
                                      const TermCatalog& catalog) {
  std::vector<bool> isWeighed(catalog.size(), false);
  for (const Compression& c : compressions) {
    const auto weights = catalog.allWeights(c.solution);
    for (std::size_t t = 0; t < weights.size(); ++t) isWeighed[t] = isWeighed[t] || weights[t] != 0;
  }
  std::vector<std::size_t> terms;
  for (std::size_t t = 0; t < catalog.size(); ++t)
    if (isWeighed[t]) terms.push_back(t);
  return terms;
}

/** A color between vermilion (-1), paper (0) and blue (1), which the color-blind tell apart. */
std::string weightColor(double share) {
  const std::array<double, 3> paper = {248, 248, 246}, blue = {0, 114, 178},
                              vermilion = {213, 94, 0};
  const auto& full = share > 0 ? blue : vermilion;
  int rgb[3];
  // The root sets small weights off from none.
  const double mix = share == 0 ? 0 : 0.15 + 0.85 * std::sqrt(std::abs(share));
  for (int i = 0; i < 3; ++i) rgb[i] = static_cast<int>(paper[i] + mix * (full[i] - paper[i]));
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
  return text;
}

}  // namespace

void drawWeights(const std::vector<Compression>& compressions, const TermCatalog& catalog,
                 const std::filesystem::path& file) {
  const auto terms = weighedTerms(compressions, catalog);
  double largest = 1e-300;
  for (const Compression& c : compressions)
    for (const double w : catalog.allWeights(c.solution)) largest = std::max(largest, std::abs(w));
  auto out =
      scriptFor(290 + 46 * std::max<std::size_t>(terms.size(), 8), 135 + 44 * compressions.size());
  out << "unset border\nunset grid\nunset key\n"
      << "set lmargin 30; set rmargin 2; set bmargin 6.5; set tmargin 1\n";
  int object = 0;
  for (std::size_t s = 0; s < compressions.size(); ++s) {
    const auto weights = catalog.allWeights(compressions[s].solution);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double weight = weights[terms[i]];
      out << "set object " << ++object << " rectangle center " << i << ',' << s
          << " size 0.94,0.9 fs solid 1 noborder fc rgb '" << weightColor(weight / largest)
          << "'\n";
      char text[32];
      std::snprintf(text, sizeof text, "%+.3g", weight);
      if (weight != 0)
        out << "set label " << object << " '" << text << "' at " << i << ',' << s
            << " center font ',10' front\n";
    }
  }
  out << "set xtics rotate by 38 right scale 0 "
      << tics(terms.size(), [&](std::size_t i) { return catalog.name(terms[i]); }) << '\n'
      << "set ytics scale 0 "
      << tics(compressions.size(),
              [&](std::size_t s) {
                char text[160];
                std::snprintf(text, sizeof text, "%.100s (alpha %.4g)",
                              compressions[s].solution.name.c_str(), compressions[s].alpha);
                return std::string(text);
              })
      << '\n'
      << "plot [-0.5:" << static_cast<double>(terms.size()) - 0.5 << "] ["
      << static_cast<double>(compressions.size()) - 0.5 << ":-0.5] NaN notitle\n";
  drawWithGnuplot(out.str(), file);
}

}  // namespace semantic_map_compress
