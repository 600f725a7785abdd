#include "FilesPanel.h"

#include <strict_files/OptionList.h>

#include <cmath>
#include <utility>

#include "map_window/Widgets.h"

namespace semantic_map_view {

namespace {
constexpr int kFilesWidth = 230;
}

FilesPanel::FilesPanel(Viewer& viewer, TrackScene& tracks, PlanPanel& plan,
                       const WantedTiles& wanted)
    : m_viewer(viewer), m_tracks(tracks), m_plan(plan), m_wantedTiles(wanted) {
  auto* content = viewer.window().addPanel(ViewWindow::Side::Left, "Files", kFilesWidth)->content();
  auto* row = addRow(content);
  addText(row, "open", 40);
  m_field = row->add<nanogui::TextBox>("");
  m_field->setEditable(true);
  m_field->setAlignment(nanogui::TextBox::Alignment::Left);
  m_field->setFixedSize({kFilesWidth - 46, 22});
  m_field->setFontSize(15);
  m_field->setPlaceholder("a name, or drop files here");
  m_field->setTooltip(
      "Maps; trajectories (.tum, .txt) and paths (.csv); an order of classes, a vehicle (.yaml)");
  m_field->setCallback([this](const std::string& file) {
    if (!file.empty()) want(file);
    return false;  // empty again
  });
  m_list = addScroll(content, kFilesWidth, 40);
  listTracks();
  viewer.window().addDropFilesCallback([this](const std::vector<std::string>& files) {
    for (const auto& file : files) want(file);
    return true;
  });
  viewer.onFrame([this] { openWanted(); });
}

void FilesPanel::want(const std::string& file) {
  m_wanted.push_back(file);
  m_viewer.window().redraw();
}

void FilesPanel::openWanted() {
  for (const std::string& file : std::exchange(m_wanted, {})) {
    try {
      open(file);
    } catch (const std::exception& e) {
      m_viewer.complain(e);
    }
  }
}

void FilesPanel::open(const std::string& file) {
  std::string text = "opened " + file + ": ";
  if (std::filesystem::path(file).extension() == ".yaml") {
    text += m_plan.open(file);
  } else if (isTrack(file)) {
    m_tracks.add(readTrack(file));
    listTracks();
    text +=
        strict_files::textOf(std::round(m_tracks.track(m_tracks.size() - 1).length() * 10) / 10) +
        " m";
  } else {
    m_viewer.add(std::make_unique<Layer>(file, m_wantedTiles));
    const Layer& layer = m_viewer.layer(m_viewer.numLayers() - 1);
    text += std::to_string(layer.map().getNumLeafNodes()) + " leaves";
    if (!layer.note().empty()) text += "; " + layer.note();
  }
  m_viewer.say(text);
}

/** The last one first. */
void FilesPanel::listTracks() {
  removeChildren(m_list);
  for (std::size_t i = m_tracks.size(); i-- > 0;) {
    auto* box = addCheckBox(m_list, m_tracks.track(i).name, kFilesWidth - 20);
    box->setChecked(m_tracks.isShown(i));
    box->setCallback([this, i](bool on) {
      m_tracks.setShown(i, on);
      m_viewer.say((on ? "shows " : "hides ") + m_tracks.track(i).name);
    });
  }
  m_list->parent()->setVisible(m_tracks.size() > 0);
}

}  // namespace semantic_map_view
