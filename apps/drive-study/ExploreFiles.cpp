#include "ExploreFiles.h"

#include <strict_files/TextFile.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace drive_study {

namespace {

using Trials = std::vector<const ExploreTrial*>;

/** "340 (5 of 6)": the median of all, those that never came so far being the largest. */
std::string metersTo(double share, const Trials& trials) {
  std::vector<double> meters;
  for (const ExploreTrial* t : trials) meters.push_back(t->metersTo(share));
  std::sort(meters.begin(), meters.end());
  const auto came = std::count_if(meters.begin(), meters.end(), [](double m) { return m < 1e9; });
  const std::size_t n = meters.size();
  const double median = (meters[(n - 1) / 2] + meters[n / 2]) / 2;
  std::ostringstream out;
  if (std::isfinite(median))
    out << std::round(median);
  else
    out << "never";
  out << " (" << came << " of " << n << ")";
  return out.str();
}

double meanShare(const Trials& trials) {
  double sum = 0;
  for (const ExploreTrial* t : trials) sum += t->share();
  return sum / static_cast<double>(trials.size());
}

std::string row(Exploring how, const Trials& trials) {
  int collisions = 0, unreached = 0;
  for (const ExploreTrial* t : trials) collisions += t->collisions, unreached += t->unreached;
  std::ostringstream out;
  out << "| " << strict_files::nameIn(choicesOf(how), how) << " |";
  for (const double share : {0.5, 0.8, 0.9}) out << ' ' << metersTo(share, trials) << " |";
  out << ' ' << std::round(meanShare(trials) * 1000) / 10 << " | " << unreached << " | "
      << collisions << " |\n";
  return out.str();
}

}  // namespace

std::string toCsv(const std::vector<ExploreTrial>& trials) {
  std::ostringstream out;
  out << "scene,number,strategy,meters,known,end\n";
  for (const ExploreTrial& t : trials)
    for (const KnownShare& k : t.known)
      out << t.scene << ',' << t.number << ',' << strict_files::nameIn(choicesOf(t.how), t.how)
          << ',' << k.meters << ',' << k.share << ',' << strict_files::csvField(t.end) << '\n';
  return out.str();
}

std::string toMarkdown(const std::vector<ExploreTrial>& trials) {
  std::string text =
      "| strategy | m to 50 % | m to 80 % | m to 90 % | known in the end, % | views that could not "
      "be reached | collisions |\n|---|---|---|---|---|---|---|\n";
  for (const auto& [name, how] : choicesOf(Exploring())) {
    Trials some;
    for (const ExploreTrial& t : trials)
      if (t.how == how) some.push_back(&t);
    if (!some.empty()) text += row(how, some);
  }
  return text;
}

}  // namespace drive_study
