#include "ShowPanel.h"

#include <semantic_types/ClassColors.h>

#include <algorithm>
#include <numeric>

#include "Widgets.h"

namespace map_window {

using nanogui::Widget;

namespace {

constexpr int kShowWidth = 230;

/** 1234567 -> "1.23 M" */
std::string shortNumber(double number) {
  char text[32];
  if (number < 10000)
    std::snprintf(text, sizeof text, "%.0f", number);
  else if (number < 1e6)
    std::snprintf(text, sizeof text, "%.1f k", number / 1e3);
  else
    std::snprintf(text, sizeof text, "%.2f M", number / 1e6);
  return text;
}

std::string nameOf(const Layer& layer) {
  return layer.name() + ": " + shortNumber(double(layer.map().getNumLeafNodes())) + " leaves";
}

}  // namespace

ShowPanel::ShowPanel(Viewer& viewer)
    : m_viewer(viewer), m_window(addWindow(&viewer.window(), "Map", {8, 8}, kShowWidth + 16)) {
  addLayers(m_window);
  addColoring(m_window);
  addClasses(m_window);
  addHeight(m_window);
  addCameras(m_window);
  m_camera = addText(m_window, "", kShowWidth);
  m_said = addText(m_window, "", kShowWidth);
  viewer.onActivated([this] { listClasses(); });
  viewer.onFrame([this] { update(); });
}

void ShowPanel::refresh() {
  if (m_name) m_name->setCaption(nameOf(m_viewer.layer()));
  listClasses();
  fitHeight();
}

void ShowPanel::update() {
  m_camera->setCaption("--camera " + m_viewer.window().orbitCamera().text());
  m_said->setCaption(m_viewer.said());
}

void ShowPanel::addLayers(Widget* parent) {
  std::vector<std::string> names;
  for (const auto& layer : m_viewer.layers()) names.push_back(nameOf(*layer));
  if (names.size() == 1) {
    m_name = addText(parent, names[0], kShowWidth);
    return;
  }
  auto* box = parent->add<nanogui::ComboBox>(names);
  box->setFixedWidth(kShowWidth);
  box->setCallback([this](int layer) { m_viewer.activate(std::size_t(layer)); });
}

void ShowPanel::addColoring(Widget* parent) {
  auto* row = addRow(parent);
  addText(row, "color", 50);
  std::vector<std::string> names;
  int chosen = 0;
  const auto& choices = choicesOf(map_view::Coloring());
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
}

void ShowPanel::addClasses(Widget* parent) {
  auto* scroll = parent->add<nanogui::VScrollPanel>();
  scroll->setFixedSize({kShowWidth, 300});
  m_classes = scroll->add<Widget>();
  m_classes->setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, 2, 1));
  listClasses();
  auto* free = parent->add<nanogui::CheckBox>("free space");
  free->setChecked(m_viewer.style().freeSpace);
  free->setCallback([this](bool on) {
    map_view::ViewStyle style = m_viewer.style();
    style.freeSpace = on;
    m_viewer.setStyle(style);
  });
}

/** The most frequent first. */
void ShowPanel::listClasses() {
  while (m_classes->childCount() > 0) m_classes->removeChild(0);
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
    auto* box = row->add<nanogui::CheckBox>(classes.name(classId));
    box->setFixedSize({135, 17});
    box->setFontSize(15);
    box->setChecked(id >= hidden.size() || !hidden[id]);
    box->setCallback([this, id](bool on) { hide(id, !on); });
    addText(row, shortNumber(double(leaves[id])), 50);
  }
  m_viewer.window().performLayout();
}

void ShowPanel::hide(std::size_t id, bool hidden) {
  map_view::ViewStyle style = m_viewer.style();
  style.hiddenClasses.resize(m_viewer.layer().leavesOfClass().size(), false);
  style.hiddenClasses[id] = hidden;
  m_viewer.setStyle(style);
}

void ShowPanel::addHeight(Widget* parent) {
  auto* row = addRow(parent);
  addText(row, "height", 50);
  m_heightSlider = addSlider(row, 110, 0, 1, 0, [this](float z) {
    map_view::ViewStyle style = m_viewer.style();
    style.maxHeight =
        z < m_heightSlider->range().second ? double(z) : std::numeric_limits<double>::infinity();
    m_viewer.setStyle(style);
    fitHeight();
  });
  m_height = addText(row, "", 55);
  fitHeight();
}

void ShowPanel::fitHeight() {
  double x, y, low, high;
  m_viewer.layer().map().getMetricMin(x, y, low);
  m_viewer.layer().map().getMetricMax(x, y, high);
  const double cut = std::min(m_viewer.style().maxHeight, high);
  m_heightSlider->setRange({float(low), float(high)});
  m_heightSlider->setValue(float(cut));
  m_height->setCaption(strict_files::textOf(std::round(cut * 10) / 10) + " m");
}

void ShowPanel::addCameras(Widget* parent) {
  auto* row = addRow(parent, 4);
  struct Preset {
    const char* name;
    double azimuth, elevation;
  };
  for (const Preset& preset : {Preset{"top", -90, 90}, Preset{"south", -90, 20},
                               Preset{"east", 0, 20}, Preset{"all", -120, 35}}) {
    auto* button = row->add<nanogui::Button>(preset.name);
    button->setFixedSize({44, 22});
    button->setFontSize(15);
    button->setCallback([this, preset] { m_viewer.lookFrom(preset.azimuth, preset.elevation); });
  }
  auto* picture = row->add<nanogui::Button>("PNG");
  picture->setFixedSize({38, 22});
  picture->setFontSize(15);
  picture->setTooltip("Writes this picture into the working folder");
  picture->setCallback([this] {
    try {
      m_viewer.say("wrote " + m_viewer.savePicture(".").string());
    } catch (const std::exception& e) {
      m_viewer.say(e.what());
    }
  });
}

}  // namespace map_window
