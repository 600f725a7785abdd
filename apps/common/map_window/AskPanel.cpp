#include "AskPanel.h"

#include <map_view/CellSource.h>
#include <map_view/OrbitCamera.h>
#include <mrpt_compat/Drawing.h>
#include <semantic_types/ClassTable.h>

#include <cstdarg>
#include <ostream>

#include "StandardOutput.h"
#include "Widgets.h"

namespace map_window {

using map_view::CellAnswer;
using mrpt::math::TPoint3D;
using mrpt_compat::drawing::CBox;

namespace {

constexpr int kWidth = 280;
constexpr semantic_types::Color kFreeColor{120, 180, 235};
constexpr std::size_t kMostBars = 5;

std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string text(const char* format, ...) {
  char line[200];
  va_list values;
  va_start(values, format);
  std::vsnprintf(line, sizeof line, format, values);
  va_end(values);
  return line;
}

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
  m_lines[0]->setCaption(text("%s, p(occupied) %.3f", answer.state.c_str(), answer.occupancy));
  m_lines[1]->setCaption(
      text("key %d %d %d, edge %g m", answer.key[0], answer.key[1], answer.key[2], answer.size));
  m_lines[2]->setCaption(text("center %.2f %.2f %.2f m", c.x(), c.y(), c.z()));
  notes() << m_lines[0]->caption() << "; " << m_lines[1]->caption() << "; " << m_lines[2]->caption()
          << std::endl;
  std::vector<Bar> bars;
  for (const auto& share : answer.shares) {
    const auto color = share.id == 0
                           ? kFreeColor
                           : semantic_types::colorOf(share.id, m_viewer.layer().map().classes());
    bars.push_back(
        {share.name, text("%.1f %%", 100 * share.probability), share.probability, color});
  }
  if (bars.size() > kMostBars) bars.resize(kMostBars);
  m_shares->setBars(std::move(bars));
  m_mark->insert(boxAround(answer));
  m_viewer.window().setRing(answer.center);
}

}  // namespace map_window
