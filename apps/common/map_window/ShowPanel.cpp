#include "ShowPanel.h"

#include <map_view/CellSource.h>
#include <map_view/OrbitCamera.h>
#include <mrpt/core/format.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_types/ClassTable.h>

#include <algorithm>
#include <numeric>
#include <ostream>

#include "Terminal.h"
#include "Widgets.h"

namespace map_window {

using map_view::CellAnswer;
using mrpt::math::TPoint3D;
using mrpt_compat::drawing::CBox;

namespace {

constexpr int kWidth = 280;
constexpr semantic_types::Color kFreeColor{120, 180, 235};
constexpr std::size_t kMostBars = 5;

/** A little larger than the cell, and opaque: MRPT draws lit objects before the map, which would
 * not show through. */
CBox::Ptr boxAround(const CellAnswer& answer) {
  const double half = answer.size / 2 * 1.04;
  const auto& c = answer.center;
  const auto box = CBox::Create(TPoint3D(c.x() - half, c.y() - half, c.z() - half),
                                TPoint3D(c.x() + half, c.y() + half, c.z() + half));
  box->setColor_u8(255, 215, 0);
  box->enableBoxBorder(true);
  box->setBoxBorderColor({0, 0, 0});
  return box;
}

}  // namespace

AskPanel::AskPanel(Viewer& viewer) : m_viewer(viewer) {
  auto* content = viewer.window().addPanel(ViewWindow::Side::Right, "Cell", kWidth)->content();
  for (auto& line : m_lines) line = addText(content, "", kWidth);
  m_lines[0]->setCaption("click a cell");
  m_shares = content->add<BarChart>();
  viewer.window().marks()->insert(m_mark);
  viewer.onActivated([this] { clear(); });
}

void AskPanel::clear() {
  m_mark->clear();
  m_viewer.window().setRing({});
  m_shares->setBars({});
  for (auto* line : m_lines) line->setCaption("");
}

std::optional<map_view::ViewCell> AskPanel::ask(const map_view::Ray& ray) {
  const Layer& layer = m_viewer.layer();
  clear();
  const auto cell = firstShown(layer.cells(), layer.look(), ray);
  if (cell)
    show(*cell);
  else
    m_lines[0]->setCaption("nothing there");
  m_viewer.window().redraw();
  return cell;
}

void AskPanel::show(const map_view::ViewCell& cell) {
  const CellAnswer answer = answerOf(cell, m_viewer.layer().map());
  const auto& c = answer.center;
  const bool isVoxel = answer.size < 1.5 * m_viewer.layer().map().getResolution();
  m_lines[0]->setCaption(mrpt::format(isVoxel ? "%s, p(occupied) %.3f" : "%s, p up to %.3f",
                                      answer.state.c_str(), answer.occupancy));
  m_lines[1]->setCaption(mrpt::format("key %d %d %d, edge %g m", answer.key[0], answer.key[1],
                                      answer.key[2], answer.size));
  m_lines[2]->setCaption(mrpt::format("center %.2f %.2f %.2f m", c.x(), c.y(), c.z()));
  notes() << m_lines[0]->caption() << "; " << m_lines[1]->caption() << "; " << m_lines[2]->caption()
          << std::endl;
  std::vector<Bar> bars;
  for (const auto& share : answer.shares) {
    const auto color = share.id == 0
                           ? kFreeColor
                           : semantic_types::colorOf(share.id, m_viewer.layer().map().classes());
    bars.push_back(
        {share.name, mrpt::format("%.1f %%", 100 * share.probability), share.probability, color});
  }
  if (bars.size() > kMostBars) bars.resize(kMostBars);
  m_shares->setBars(std::move(bars));
  m_mark->insert(boxAround(answer));
  m_viewer.window().setRing(answer.center);
}

using nanogui::Widget;

namespace {

constexpr int kShowWidth = 230, kSaidWidth = 400;

/** 1234567 -> "1.23 M" */
std::string shortNumber(double number) {
  if (number < 10000) return mrpt::format("%.0f", number);
  return number < 1e6 ? mrpt::format("%.1f k", number / 1e3) : mrpt::format("%.2f M", number / 1e6);
}

std::string captionOf(const Layer& layer) {
  return layer.name() + ": " + shortNumber(double(layer.map().getNumLeafNodes())) + " leaves";
}

}  // namespace

ShowPanel::ShowPanel(Viewer& viewer)
    : m_viewer(viewer),
      m_content(viewer.window().addPanel(ViewWindow::Side::Left, "Map", kShowWidth)->content()) {
  addLayers();
  addColoring(m_content);
  addClasses(m_content);
  addCameras(m_content);
  m_camera = addLines(m_content, kShowWidth);
  m_said = new nanogui::Window(&viewer.window(), "");
  m_said->setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, 6));
  addLines(m_said, kSaidWidth);
  addClip();
  viewer.onActivated([this] { listClasses(); });
  viewer.onAdded([this] {
    listLayers();
    fitClip();
  });
  viewer.onFrame([this] { update(); });
}

void ShowPanel::refresh() {
  m_name->setCaption(captionOf(m_viewer.layer()));
  listClasses();
  fitClip();
}

void ShowPanel::update() {
  m_camera->setCaption("--camera " + m_viewer.window().orbitCamera().text());
  static_cast<nanogui::Label*>(m_said->childAt(0))->setCaption(m_viewer.said());
  m_said->setVisible(!m_viewer.said().empty());
  const ViewWindow& window = m_viewer.window();
  m_said->setPosition(
      {(window.width() - m_said->width()) / 2, window.height() - m_said->height() - 8});
  const auto scale = m_viewer.layer().look().scale();
  m_scale->setVisible(scale.has_value());
  if (scale) m_scale->setScale(*scale);
}

void ShowPanel::addLayers() {
  m_layers = addColumn(m_content, 0, 5);
  m_activeRow = addRow(m_content);
  addText(m_activeRow, "active", 50);
  m_active = m_activeRow->add<nanogui::ComboBox>();
  m_active->setFixedWidth(kShowWidth - 56);
  m_active->setTooltip("The one that clicks ask, that is compressed and planned upon");
  m_active->setCallback([this](int layer) {
    m_viewer.activate(std::size_t(layer));
    m_shown[std::size_t(layer)]->setChecked(true);
  });
  listLayers();
}

void ShowPanel::listLayers() {
  removeChildren(m_layers);
  m_shown.clear();
  m_activeRow->setVisible(m_viewer.numLayers() > 1);
  if (m_viewer.numLayers() == 1) {
    m_name = addText(m_layers, captionOf(m_viewer.layer()), kShowWidth);
    return;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < m_viewer.numLayers(); ++i) {
    names.push_back(m_viewer.layer(i).name());
    const auto show = [this, i](bool on) {
      m_viewer.setShown(i, on);
      m_viewer.say((on ? "shows " : "hides ") + m_viewer.layer(i).name());
    };
    m_shown.push_back(
        addCheckBox(m_layers, captionOf(m_viewer.layer(i)), kShowWidth, m_viewer.isShown(i), show));
  }
  m_active->setItems(names);
}

void ShowPanel::addColoring(Widget* parent) {
  auto* row = addRow(parent);
  addText(row, "color", 50);
  std::vector<std::string> names;
  int chosen = 0;
  const auto& choices = choicesOf(map_view::ViewColoring());
  for (std::size_t i = 0; i < choices.size(); ++i) {
    names.push_back(choices[i].first);
    if (choices[i].second == m_viewer.style().coloring) chosen = int(i);
  }
  auto* box = row->add<nanogui::ComboBox>(names);
  box->setFixedWidth(kShowWidth - 56);
  box->setSelectedIndex(chosen);
  box->setCallback([this, &choices](int i) {
    map_view::ViewStyle style = m_viewer.style();
    style.coloring = choices[std::size_t(i)].second;
    m_viewer.setStyle(style);
  });
  m_scale = parent->add<ScaleBar>();
  m_scale->setFixedSize({kShowWidth, 36});
}

void ShowPanel::addClasses(Widget* parent) {
  m_classes = addScroll(parent, kShowWidth, 230);
  listClasses();
  auto* row = addRow(parent);
  addSpace(row, "free space", &map_view::ViewStyle::freeSpace);
  addSpace(row, "unknown", &map_view::ViewStyle::unknownSpace);
}

void ShowPanel::addSpace(Widget* parent, const std::string& name,
                         bool map_view::ViewStyle::*isShown) {
  auto* box = parent->add<nanogui::CheckBox>(name);
  box->setFixedSize({kShowWidth / 2 - 3, 20});
  box->setChecked(m_viewer.style().*isShown);
  box->setCallback([this, isShown](bool on) {
    map_view::ViewStyle style = m_viewer.style();
    style.*isShown = on;
    m_viewer.setStyle(style);
  });
}

/** The most frequent first. */
void ShowPanel::listClasses() {
  removeChildren(m_classes);
  const std::vector<std::size_t>& leaves = m_viewer.layer().leavesOfClass();
  std::vector<std::size_t> ids(leaves.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::stable_sort(ids.begin(), ids.end(),
                   [&](std::size_t a, std::size_t b) { return leaves[a] > leaves[b]; });
  const auto& hidden = m_viewer.style().hiddenClasses;
  const auto& classes = m_viewer.layer().map().classes();
  for (const std::size_t id : ids) {
    if (leaves[id] == 0) break;
    const auto classId = static_cast<semantic_types::ClassId>(id);
    auto* row = addRow(m_classes);
    new Swatch(row, semantic_types::colorOf(classId, classes));
    addCheckBox(row, classes.name(classId), 135, id >= hidden.size() || !hidden[id],
                [this, id](bool on) { hide(id, !on); });
    addText(row, shortNumber(double(leaves[id])), 50);
  }
}

void ShowPanel::hide(std::size_t id, bool hidden) {
  map_view::ViewStyle style = m_viewer.style();
  style.hiddenClasses.resize(m_viewer.layer().leavesOfClass().size(), false);
  style.hiddenClasses[id] = hidden;
  m_viewer.setStyle(style);
}

void ShowPanel::addClip() {
  auto* content =
      m_viewer.window().addPanel(ViewWindow::Side::Left, "Clip", kShowWidth, false)->content();
  for (int axis = 0; axis < 3; ++axis)
    for (const bool isHigh : {false, true}) {
      ClipLine& line = m_clip[std::size_t(axis)][isHigh];
      auto* row = addRow(content, 4);
      addText(row, isHigh ? "" : std::string(1, char('x' + axis)), 10);
      line.slider = addSlider(row, 138, 0, 1, 0, [=](float to) { clip(axis, isHigh, double(to)); });
      line.number = row->add<nanogui::FloatBox<double>>();
      line.number->setFixedSize({74, 20});
      line.number->setFontSize(15);
      line.number->setEditable(true);
      line.number->setUnits("m");
      line.number->numberFormat("%.1f");
      line.number->setCallback([=](double to) { clip(axis, isHigh, to); });
    }
  fitClip();
}

/** The sliders' ends do not cut, and no side passes the other. */
void ShowPanel::clip(int axis, bool isHigh, double to) {
  map_view::ViewStyle style = m_viewer.style();
  const Eigen::AlignedBox3d all = map_view::ViewStyle::everywhere();
  const auto [low, high] = m_clip[std::size_t(axis)][isHigh].slider->range();
  if (isHigh)
    style.clip.max()[axis] =
        to < double(high) ? std::max(to, style.clip.min()[axis]) : all.max()[axis];
  else
    style.clip.min()[axis] =
        to > double(low) ? std::min(to, style.clip.max()[axis]) : all.min()[axis];
  m_viewer.setStyle(style);
  fitClip();
}

void ShowPanel::fitClip() {
  Eigen::AlignedBox3d known;
  for (std::size_t i = 0; i < m_viewer.numLayers(); ++i) {
    Eigen::Vector3d low, high;
    m_viewer.layer(i).map().getMetricMin(low.x(), low.y(), low.z());
    m_viewer.layer(i).map().getMetricMax(high.x(), high.y(), high.z());
    known.extend(Eigen::AlignedBox3d(low, high));
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const bool isHigh : {false, true}) {
      const ClipLine& line = m_clip[std::size_t(axis)][isHigh];
      const double low = known.min()[axis], high = known.max()[axis];
      const auto& clip = m_viewer.style().clip;
      const double at = std::clamp((isHigh ? clip.max() : clip.min())[axis], low, high);
      line.slider->setRange({float(low), float(high)});
      line.slider->setValue(float(at));
      line.number->setValue(at);
    }
}

void ShowPanel::addCameras(Widget* parent) {
  auto* row = addRow(parent, 4);
  struct Preset {
    const char* name;
    double azimuth, elevation;
  };
  for (const Preset& preset : {Preset{"top", -90, 90}, Preset{"south", -90, 20},
                               Preset{"east", 0, 20}, Preset{"all", -120, 35}}) {
    addButton(row, preset.name, 44,
              [this, preset] { m_viewer.lookFrom(preset.azimuth, preset.elevation); });
  }
  auto* picture = addButton(row, "PNG", 38, [this] {
    m_viewer.attempt([this] { m_viewer.say("wrote " + m_viewer.savePicture(".").string()); });
  });
  picture->setTooltip("Writes this picture into the working folder");
}

}  // namespace map_window
