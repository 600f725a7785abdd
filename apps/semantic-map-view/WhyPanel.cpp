#include "WhyPanel.h"

#include <algorithm>
#include <numeric>
#include <ostream>

#include "StandardOutput.h"
#include "map_window/Widgets.h"

namespace semantic_map_view {

using map_view::LiveCompression;
using Balance = map_view::InformationTree::Balance;

namespace {

constexpr int kLeft = 262, kNames = 116, kColumn = 66, kLine = 17;
constexpr std::size_t kMostNodes = 4, kMostTerms = 6;

std::string rounded(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

std::string edgeOf(const Balance& balance, const LiveCompression& live, double voxelSize) {
  return rounded(live.tree().cube(balance.node).edge() * voxelSize) + " m";
}

std::string textOf(const Balance& balance, const LiveCompression& live) {
  std::string text = live.isExpanded(balance.node) ? "expanded" : "not expanded";
  text += ", G " + rounded(balance.gValue) + " = max(0, " + rounded(balance.gain) + " - " +
          rounded(live.alpha()) + " * " + rounded(balance.splitEntropy) + " + " +
          rounded(balance.ofChildren) + ")";
  for (std::size_t t = 0; t < live.numTerms(); ++t)
    text += ", " + live.name(t) + " " + rounded(live.weight(t)) + " * " +
            rounded(balance.divergences[t]);
  return text;
}

/** The terms that weigh most in one of the nodes, in their own order. */
std::vector<std::size_t> largestTerms(const std::vector<Balance>& balances,
                                      const LiveCompression& live) {
  std::vector<std::size_t> terms(live.numTerms());
  std::iota(terms.begin(), terms.end(), 0);
  const auto most = [&](std::size_t t) {
    double value = 0;
    for (const Balance& b : balances)
      value = std::max(value, std::abs(live.weight(t)) * b.divergences[t]);
    return value;
  };
  std::stable_sort(terms.begin(), terms.end(),
                   [&](std::size_t a, std::size_t b) { return most(a) > most(b); });
  terms.resize(std::min(terms.size(), kMostTerms));
  std::sort(terms.begin(), terms.end());
  return terms;
}

std::vector<std::vector<std::string>> rowsOf(const std::vector<Balance>& balances,
                                             const LiveCompression& live, double voxelSize) {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::string& name, const auto& value) {
    rows.push_back({name});
    for (const Balance& balance : balances) rows.back().push_back(value(balance));
  };
  add("edge", [&](const Balance& b) { return edgeOf(b, live, voxelSize); });
  add("expanded", [&](const Balance& b) { return live.isExpanded(b.node) ? "yes" : "no"; });
  for (const std::size_t t : largestTerms(balances, live))
    add(rounded(live.weight(t)) + " x " + live.name(t),
        [t](const Balance& b) { return rounded(b.divergences[t]); });
  add("sum of all", [](const Balance& b) { return rounded(b.gain); });
  add("- alpha x H", [&](const Balance& b) { return rounded(-live.alpha() * b.splitEntropy); });
  add("+ children's G", [](const Balance& b) { return rounded(b.ofChildren); });
  add("G, at least 0", [](const Balance& b) { return rounded(b.gValue); });
  return rows;
}

}  // namespace

WhyPanel::WhyPanel(Viewer& viewer, CompressPanel& compress)
    : m_viewer(viewer), m_compress(compress) {
  const int width = kNames + kColumn * int(kMostNodes);
  const int height = kLine * (int(kMostTerms) + 6);
  m_window = addWindow(&viewer.window(), "Why it is expanded, or not (nats)",
                       {kLeft, viewer.window().height() - height - 56}, width + 16);
  m_table = m_window->add<Table>(kNames, kColumn);
  m_table->setFixedSize({width, height});
  m_window->setVisible(false);
  viewer.onActivated([this] { show({}); });
  compress.onFollowed([this] { update(); });
}

void WhyPanel::show(const std::optional<map_view::ViewCell>& cell) {
  m_cell = cell;
  m_told.clear();
  update();
}

void WhyPanel::update() {
  const LiveCompression* live = m_compress.compression();
  m_window->setVisible(m_cell && live);
  if (!m_cell || !live) return;
  const double voxelSize = m_viewer.layer().map().getResolution();
  std::vector<Balance> balances = live->balancesAround(m_cell->lowest);
  // What is below the cell would not say why it is as large as it is.
  const auto isBelow = [&](const Balance& b) {
    return live->tree().cube(b.node).edge() < m_cell->edge();
  };
  balances.erase(std::remove_if(balances.begin(), balances.end(), isBelow), balances.end());
  std::string told;
  for (const Balance& balance : balances)
    told += edgeOf(balance, *live, voxelSize) + ": " + textOf(balance, *live) + "\n";
  if (told != m_told) notes() << told << std::flush;
  m_told = told;
  if (balances.size() > kMostNodes)
    balances.erase(balances.begin(), balances.end() - std::ptrdiff_t(kMostNodes));
  m_table->setRows(rowsOf(balances, *live, voxelSize));
}

}  // namespace semantic_map_view
