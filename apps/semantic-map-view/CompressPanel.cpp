#include "CompressPanel.h"

#include <GLFW/glfw3.h>
#include <mrpt/core/format.h>
#include <semantic_octree/TreeFile.h>
#include <strict_files/TextFile.h>
#include <strict_files/Words.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>

#include "Terminal.h"

namespace semantic_map_view {

namespace fs = std::filesystem;
using map_view::LiveCompression;

namespace {

constexpr int kWidth = 280;
constexpr double kRest = 0.25;  // s
/** One leaf in so many: a start from which sliders lead to both sides. */
constexpr std::size_t kShare = 10;

}  // namespace

CompressPanel::CompressPanel(Viewer& viewer, fs::path weights)
    : m_viewer(viewer), m_weights(std::move(weights)) {
  auto* content = viewer.window().addPanel(ViewWindow::Side::Right, "Compress", kWidth)->content();
  m_on = content->add<nanogui::CheckBox>("show the compressed tree");
  m_on->setCallback([this](bool on) { m_viewer.attempt([&] { switchOn(on); }); });
  m_controls = addColumn(content, 0, 4);
  viewer.onActivated([this] { forget(); });
  viewer.onFrame([this] { update(); });
}

void CompressPanel::begin() {
  auto& map = m_viewer.layer().ownMap();
  if (m_weights.empty()) {
    // Blocks of 3.2 m in streets would be larger than rooms in flats.
    constexpr double kBlock = 16;  // voxels
    semantic_octree::AbstractionOptions space;
    space.blockSize = kBlock * map.getResolution();
    m_live.emplace(map, LiveCompression::allClasses(map, space));
    m_live->setLeaves(map.getNumLeafNodes() / kShare);
  } else {
    m_live.emplace(map, semantic_octree::loadWeights(m_weights, map.classes()).front());
  }
  tell(0);
}

void CompressPanel::forget() {
  m_live.reset();
  m_lines.clear();
  m_on->setChecked(false);
  removeChildren(m_controls);
  m_onFollowed();
}

void CompressPanel::switchOn(bool on) {
  m_on->setChecked(on);
  if (!on) return m_viewer.showCompressed(nullptr);
  if (!m_live) {
    begin();
    addAlpha();
    addWanted();
    addTerms();
    addSave();
  }
  m_viewer.showCompressed(&*m_live);
  follow();
}

void CompressPanel::addAlpha() {
  auto* row = addRow(m_controls);
  addText(row, "alpha", 45);
  m_alpha = addSlider(row, 150, 0, 1, sliderOf(m_live->alpha()),
                      [this](float at) { m_viewer.attempt([&] { setAlpha(alphaOf(at)); }); });
  m_alphaText = addText(row, "", 75);
}

void CompressPanel::addWanted() {
  const auto add = [this](nanogui::Label*& text, const std::string& what, const auto& set) {
    auto* row = addRow(m_controls);
    text = addText(row, "", 130);
    auto* box = row->add<nanogui::IntBox<int>>(0);
    box->setEditable(true);
    box->setFixedSize({90, 20});
    box->setMinValue(1);
    box->setTooltip("Wanted number of " + what);
    box->setCallback([this, set](int n) { m_viewer.attempt([&] { set(std::size_t(n)); }); });
    return box;
  };
  m_wantedLeaves = add(m_leaves, "leaves", [this](std::size_t n) { setLeaves(n); });
  m_wantedKilobytes = add(m_bytes, "kB", [this](std::size_t n) { setBytes(1000 * n); });
  m_wantedKilobytes->setUnits("kB");
}

/** Whether a slider is worth its place: not for classes that the map does not have. */
bool CompressPanel::isThere(std::size_t term) const {
  const Layer& layer = m_viewer.layer();
  const auto id = layer.map().classes().find(m_live->name(term));
  return !id || layer.leavesOfClass()[*id] > 0 || m_live->weight(term) != 0;
}

void CompressPanel::addTerms() {
  auto* terms = addScroll(m_controls, kWidth, 150);
  for (std::size_t term = 0; term < m_live->numTerms(); ++term) {
    m_lines.emplace_back();
    if (!isThere(term)) continue;
    auto* row = addRow(terms, 4);
    addText(row, m_live->name(term), 92);
    TermLine& line = m_lines.back();
    addSlider(row, 80, m_live->mayBeIrrelevant(term) ? -2.f : 0.f, 2, float(m_live->weight(term)),
              [this, term](float w) {
                const double weight = std::round(w * 20) / 20;
                if (weight == m_live->weight(term)) return;
                m_viewer.attempt([&] {
                  m_live->setWeight(term, weight);
                  follow();
                });
              });
    line.weight = addText(row, "", 36);
    line.kept = addText(row, "", 46);
  }
}

void CompressPanel::addSave() {
  auto* save = addButton(m_controls, "save the weights", 120, [this] {
    m_viewer.attempt([&] {
      m_viewer.say("wrote " + this->save(".").string() + ": " +
                   std::to_string(m_live->numLeaves()) + " leaves");
    });
  });
  save->setTooltip("As YAML into the working folder, for semantic-map-compress");
}

/** Logarithmic: 0 and 1 are where the tree begins and ends to change. */
float CompressPanel::sliderOf(double alpha) const {
  const double low = std::log(m_live->lowestAlpha()), high = std::log(m_live->highestAlpha());
  return high > low ? float((std::log(std::max(alpha, 1e-300)) - low) / (high - low)) : 0.f;
}

double CompressPanel::alphaOf(float slider) const {
  const double low = std::log(m_live->lowestAlpha()), high = std::log(m_live->highestAlpha());
  return std::exp(low + double(slider) * (high - low));
}

void CompressPanel::setAlpha(double alpha) {
  m_live->setAlpha(alpha);
  follow();
}

void CompressPanel::setLeaves(std::size_t leaves) {
  m_live->setLeaves(leaves);
  m_alpha->setValue(sliderOf(m_live->alpha()));
  follow();
}

void CompressPanel::setBytes(std::size_t bytes) {
  m_live->setBytes(m_viewer.layer().map(), bytes);
  m_alpha->setValue(sliderOf(m_live->alpha()));
  follow();
  m_viewer.say("at most " + std::to_string(bytes) +
               " bytes: " + std::to_string(m_live->numLeaves()) + " leaves");
}

/** Map and numbers follow the compressed tree. */
void CompressPanel::follow() {
  auto boxes = m_live->takeChange();
  if (m_viewer.style().coloring == map_view::ViewColoring::Retained)
    boxes = {map_view::KeyBox::everything()};  // colors change where leaves do not
  m_viewer.changed(boxes);
  m_alphaText->setCaption(mrpt::format("%.3g", m_live->alpha()));
  m_leaves->setCaption(std::to_string(m_live->numLeaves()) + " leaves");
  m_wantedLeaves->setValue(int(m_live->numLeaves()));
  for (std::size_t term = 0; term < m_lines.size(); ++term)
    if (m_lines[term].weight)
      m_lines[term].weight->setCaption(mrpt::format("%.3g", m_live->weight(term)));
  m_measureAt = glfwGetTime() + kRest;
  m_onFollowed();
}

void CompressPanel::update() {
  if (m_live && m_measureAt != 0 && glfwGetTime() >= m_measureAt) measure();
}

void CompressPanel::measure() {
  m_measureAt = 0;
  const auto retained = m_live->retained();
  for (std::size_t term = 0; term < m_lines.size(); ++term) {
    const auto& share = retained[term];
    if (m_lines[term].kept)
      m_lines[term].kept->setCaption(share ? mrpt::format("%.1f", 100 * *share) + " %" : "-");
  }
  const std::size_t bytes =
      semantic_octree::fileSize(m_live->compressedMap(m_viewer.layer().map()));
  m_bytes->setCaption(strict_files::sizeText(bytes));
  m_wantedKilobytes->setValue(int((bytes + 999) / 1000));
  tell(bytes);
}

void CompressPanel::tell(std::size_t bytes) {
  std::string text = std::to_string(m_live->numLeaves()) + " leaves, alpha " +
                     strict_files::textOf(m_live->alpha());
  if (bytes > 0) text += ", " + std::to_string(bytes) + " bytes";
  if (text != m_told) notes() << text << std::endl;
  m_told = text;
}

fs::path CompressPanel::save(const fs::path& folder) const {
  const fs::path file = m_viewer.newFile(folder, "weights", ".yaml");
  strict_files::writeText(
      file, map_view::weightsText(m_live->solution(), m_viewer.layer().map().classes()));
  return file;
}

using Balance = map_view::LiveCompression::Balance;

namespace {

constexpr int kTableWidth = 280;

/** Thousandths of a nat: numbers that can be compared in columns. */
std::string thousandths(double nats) { return mrpt::format("%.1f", 1000 * nats); }

std::string edgeOf(const Balance& balance, const LiveCompression& live, double voxelSize) {
  return mrpt::format("%.3g", live.cube(balance.node).edge() * voxelSize) + " m";
}

std::string textOf(const Balance& balance, const LiveCompression& live) {
  std::string text = live.isExpanded(balance.node) ? "expanded" : "not expanded";
  text += ", G " + mrpt::format("%.3g", balance.gValue) + " = max(0, " +
          mrpt::format("%.3g", balance.gain) + " - " + mrpt::format("%.3g", live.alpha()) + " * " +
          mrpt::format("%.3g", balance.splitEntropy) + " + " +
          mrpt::format("%.3g", balance.ofChildren) + ")";
  for (std::size_t t = 0; t < live.numTerms(); ++t)
    text += ", " + live.name(t) + " " + mrpt::format("%.3g", live.weight(t)) + " * " +
            mrpt::format("%.3g", balance.divergences[t]);
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
    add((mrpt::format("%.3g", live.weight(t)) + " x " + live.name(t)).substr(0, 17),
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
  const auto isBelow = [&](const Balance& b) { return live->cube(b.node).edge() < m_cell->edge(); };
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
