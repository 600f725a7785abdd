#include "Widgets.h"

#include <nanogui/opengl.h>

#include <algorithm>
#include <numeric>

namespace map_window {

using nanogui::Vector2i;
using nanogui::Widget;

namespace {

constexpr int kFont = 15, kLine = 17, kNameWidth = 105, kBarWidth = 105, kValueWidth = 60;

void drawText(NVGcontext* context, float x, float y, int align, const std::string& text) {
  nvgTextAlign(context, align | NVG_ALIGN_MIDDLE);
  nvgText(context, x, y, text.c_str(), nullptr);
}

void fillBox(NVGcontext* context, float x, float y, float width, float height,
             const nanogui::Color& color) {
  nvgBeginPath(context);
  nvgRect(context, x, y, width, height);
  nvgFillColor(context, color);
  nvgFill(context);
}

}  // namespace

nanogui::Color colorOf(const semantic_types::Color& c) {
  return nanogui::Color(Eigen::Vector3i(c.r, c.g, c.b), 255);
}

Vector2i BarChart::preferredSize(NVGcontext*) const {
  return {kNameWidth + kBarWidth + kValueWidth, kLine * std::max<int>(1, int(m_bars.size()))};
}

void BarChart::draw(NVGcontext* context) {
  Widget::draw(context);
  nvgFontSize(context, kFont);
  nvgFontFace(context, "sans");
  float y = float(mPos.y());
  for (const Bar& bar : m_bars) {
    const float x = float(mPos.x()), middle = y + kLine / 2.f;
    nvgFillColor(context, nanogui::Color(230, 255));
    drawText(context, x, middle, NVG_ALIGN_LEFT, bar.name.substr(0, 16));
    drawText(context, x + kNameWidth + kBarWidth + kValueWidth, middle, NVG_ALIGN_RIGHT, bar.value);
    const float width = float(std::clamp(bar.share, 0.0, 1.0)) * kBarWidth;
    fillBox(context, x + kNameWidth, y + 3, width, kLine - 6, colorOf(bar.color));
    y += kLine;
  }
}

void Table::draw(NVGcontext* context) {
  Widget::draw(context);
  nvgFontSize(context, kFont);
  nvgFontFace(context, "sans");
  nvgFillColor(context, nanogui::Color(230, 255));
  float y = float(mPos.y()) + kLine / 2.f;
  for (const auto& row : m_rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const float right = float(mPos.x() + m_nameWidth + int(i) * m_columnWidth);
      if (i == 0)
        drawText(context, float(mPos.x()), y, NVG_ALIGN_LEFT, row[i].substr(0, 17));
      else
        drawText(context, right, y, NVG_ALIGN_RIGHT, row[i]);
    }
    y += kLine;
  }
}

void OrderList::setNames(std::vector<std::string> names) {
  m_names = std::move(names);
  m_order.resize(m_names.size());
  std::iota(m_order.begin(), m_order.end(), 0);
  m_held.reset();
}

Vector2i OrderList::preferredSize(NVGcontext*) const {
  return {kNameWidth + kBarWidth, kLine * int(m_names.size())};
}

void OrderList::draw(NVGcontext* context) {
  Widget::draw(context);
  nvgFontSize(context, kFont);
  nvgFontFace(context, "sans");
  float y = float(mPos.y());
  for (std::size_t line = 0; line < m_order.size(); ++line) {
    if (line == m_held)
      fillBox(context, float(mPos.x()), y, float(mSize.x()), kLine, nanogui::Color(90, 255));
    nvgFillColor(context, nanogui::Color(230, 255));
    drawText(context, float(mPos.x()) + 4, y + kLine / 2.f, NVG_ALIGN_LEFT,
             std::to_string(line + 1) + "  " + m_names[m_order[line]]);
    y += kLine;
  }
}

std::size_t OrderList::lineAt(const Vector2i& p) const {
  return std::size_t(std::clamp((p.y() - mPos.y()) / kLine, 0, int(m_order.size()) - 1));
}

bool OrderList::mouseButtonEvent(const Vector2i& p, int button, bool down, int) {
  if (button != GLFW_MOUSE_BUTTON_LEFT || m_order.empty()) return false;
  if (down) {
    m_held = lineAt(p);
    m_before = m_order;
  } else if (m_held) {
    m_held.reset();
    if (m_order != m_before) m_moved(m_order);
  }
  return true;
}

bool OrderList::mouseDragEvent(const Vector2i& p, const Vector2i&, int, int) {
  if (!m_held) return false;
  const std::size_t line = lineAt(p);
  const auto name = m_order.begin() + std::ptrdiff_t(*m_held);
  if (line < *m_held) std::rotate(m_order.begin() + std::ptrdiff_t(line), name, name + 1);
  if (line > *m_held) std::rotate(name, name + 1, m_order.begin() + std::ptrdiff_t(line) + 1);
  m_held = line;
  return true;
}

Swatch::Swatch(Widget* parent, const semantic_types::Color& color)
    : Widget(parent), m_color(colorOf(color)) {
  setFixedSize({12, 12});
}

void Swatch::draw(NVGcontext* context) {
  fillBox(context, float(mPos.x()), float(mPos.y()), float(mSize.x()), float(mSize.y()), m_color);
}

Widget* addRow(Widget* parent, int spacing) {
  auto* row = parent->add<Widget>();
  row->setLayout(new nanogui::BoxLayout(nanogui::Orientation::Horizontal,
                                        nanogui::Alignment::Middle, 0, spacing));
  return row;
}

nanogui::Label* addText(Widget* parent, const std::string& text, int width) {
  auto* label = parent->add<nanogui::Label>(text);
  label->setFixedSize({width, kLine});
  label->setFontSize(kFont);
  return label;
}

nanogui::CheckBox* addCheckBox(Widget* parent, const std::string& text, int width) {
  auto* box = parent->add<nanogui::CheckBox>(text);
  box->setFixedSize({width, kLine});
  box->setFontSize(kFont);
  return box;
}

void removeChildren(Widget* parent) {
  parent->screen()->updateFocus(nullptr);
  while (parent->childCount() > 0) parent->removeChild(parent->childCount() - 1);
}

nanogui::Window* addWindow(Widget* parent, const std::string& title, const Vector2i& place,
                           int width) {
  auto* window = new nanogui::Window(parent, title);
  window->setPosition(place);
  window->setFixedWidth(width);
  window->setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, 8, 5));
  return window;
}

nanogui::Slider* addSlider(Widget* parent, int width, float low, float high, float value,
                           const std::function<void(float)>& moved) {
  auto* slider = parent->add<nanogui::Slider>();
  slider->setFixedSize({width, 18});
  slider->setRange({low, high});
  slider->setValue(value);
  slider->setCallback(moved);
  return slider;
}

}  // namespace map_window
