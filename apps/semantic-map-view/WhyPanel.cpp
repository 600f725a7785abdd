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

constexpr int kTableWidth = 280;

std::string rounded(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

/** Thousandths of a nat: numbers that can be compared in columns. */
std::string thousandths(double nats) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", 1000 * nats);
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
  terms.resize(std::min(terms.size(), WhyPanel::kMostTerms));
  while (!terms.empty() && most(terms.back()) == 0) terms.pop_back();
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
    add((rounded(live.weight(t)) + " x " + live.name(t)).substr(0, 17),
        [t](const Balance& b) { return thousandths(b.divergences[t]); });
  add("sum of all", [](const Balance& b) { return thousandths(b.gain); });
  add("- alpha x H", [&](const Balance& b) { return thousandths(-live.alpha() * b.splitEntropy); });
  add("+ children's G", [](const Balance& b) { return thousandths(b.ofChildren); });
  add("G, at least 0", [](const Balance& b) { return thousandths(b.gValue); });
  return rows;
}

}  // namespace

WhyPanel::WhyPanel(Viewer& viewer, CompressPanel& compress)
    : m_viewer(viewer),
      m_compress(compress),
      m_panel(viewer.window().addPanel(ViewWindow::Side::Left, "Why this size (0.001 nat)",
                                       kTableWidth, false)) {
  auto* table = m_panel->content()->add<nanogui::Widget>();
  auto* grid = new nanogui::GridLayout(nanogui::Orientation::Horizontal, WhyPanel::kMostNodes + 1,
                                       nanogui::Alignment::Maximum, 0, 6);
  grid->setColAlignment({nanogui::Alignment::Minimum, nanogui::Alignment::Maximum});
  grid->setSpacing(1, 2);
  table->setLayout(grid);
  for (auto& row : m_cells)
    for (auto& cell : row) {
      cell = table->add<nanogui::Label>("");
      cell->setFontSize(15);
    }
  m_panel->setVisible(false);
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
  m_panel->setVisible(m_cell && live);
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
  if (balances.size() > WhyPanel::kMostNodes)
    balances.erase(balances.begin(), balances.end() - std::ptrdiff_t(WhyPanel::kMostNodes));
  const auto rows = rowsOf(balances, *live, voxelSize);
  for (std::size_t r = 0; r < m_cells.size(); ++r)
    for (std::size_t c = 0; c < m_cells[r].size(); ++c)
      m_cells[r][c]->setCaption(r < rows.size() && c < rows[r].size() ? rows[r][c] : "");
}

}  // namespace semantic_map_view
