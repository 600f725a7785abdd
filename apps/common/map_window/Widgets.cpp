#include "Widgets.h"

#include <nanogui/opengl.h>

#include <algorithm>

namespace map_window {

using nanogui::Vector2i;
using nanogui::Widget;

namespace {

constexpr int kMargin = 8, kFont = 15, kLine = 17, kNameWidth = 105, kBarWidth = 105,
              kValueWidth = 60;

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

Panel::Panel(Widget* parent, const std::string& title, int width)
    : nanogui::Window(parent, title), m_content(addColumn(this, 0, 5)) {
  setFixedWidth(width + 2 * kMargin);
  setLayout(
      new nanogui::BoxLayout(nanogui::Orientation::Vertical, nanogui::Alignment::Minimum, kMargin));
}

Vector2i Panel::preferredSize(NVGcontext* context) const {
  if (isOpen()) return nanogui::Window::preferredSize(context);
  return {fixedWidth(), theme()->mWindowHeaderHeight};
}

void Panel::draw(NVGcontext* context) {
  nanogui::Window::draw(context);
  nvgFontSize(context, kLine + 3);
  nvgFontFace(context, "icons");
  nvgFillColor(context, nanogui::Color(190, 255));
  const int icon = isOpen() ? ENTYPO_ICON_CHEVRON_DOWN : ENTYPO_ICON_CHEVRON_RIGHT;
  drawText(context, float(mPos.x() + kMargin),
           float(mPos.y()) + float(theme()->mWindowHeaderHeight) / 2, NVG_ALIGN_LEFT,
           nanogui::utf8(icon).data());
}

bool Panel::mouseButtonEvent(const Vector2i& p, int button, bool down, int modifiers) {
  const bool onTitle = p.y() - mPos.y() < theme()->mWindowHeaderHeight;
  if (!onTitle || !down || button != GLFW_MOUSE_BUTTON_LEFT)
    return nanogui::Window::mouseButtonEvent(p, button, down, modifiers);
  open(!isOpen());
  if (isOpen()) m_onOpened();
  return true;
}

Vector2i BarChart::preferredSize(NVGcontext*) const {
  return {kNameWidth + kBarWidth + kValueWidth, kLine * int(m_bars.size())};
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

Vector2i ScaleBar::preferredSize(NVGcontext*) const { return mFixedSize; }

void ScaleBar::draw(NVGcontext* context) {
  constexpr int kSteps = 46;
  const float x = float(mPos.x()), y = float(mPos.y()), width = float(mSize.x()),
              step = width / kSteps, below = y + kLine * 1.5f;
  for (int i = 0; i < kSteps; ++i)
    fillBox(context, x + float(i) * step, y + 2, step + 0.5f, kLine - 4,
            colorOf(m_scale.colorAt((i + 0.5) / kSteps)));
  nvgFontSize(context, kFont);
  nvgFontFace(context, "sans");
  nvgFillColor(context, nanogui::Color(230, 255));
  drawText(context, x, below, NVG_ALIGN_LEFT, m_scale.low);
  drawText(context, x + width / 2, below, NVG_ALIGN_CENTER, m_scale.what);
  drawText(context, x + width, below, NVG_ALIGN_RIGHT, m_scale.high);
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

Widget* addColumn(Widget* parent, int margin, int spacing) {
  auto* column = parent->add<Widget>();
  column->setLayout(new nanogui::BoxLayout(nanogui::Orientation::Vertical,
                                           nanogui::Alignment::Minimum, margin, spacing));
  return column;
}

Widget* addScroll(Widget* parent, int width, int height) {
  auto* scroll = parent->add<nanogui::VScrollPanel>();
  scroll->setFixedSize({width, height});
  return addColumn(scroll, 2, 1);
}

nanogui::Label* addText(Widget* parent, const std::string& text, int width) {
  auto* label = parent->add<nanogui::Label>(text);
  label->setFixedSize({width, kLine});
  label->setFontSize(kFont);
  return label;
}

nanogui::Label* addLines(Widget* parent, int width) {
  auto* label = addText(parent, "", width);
  label->setFixedHeight(0);
  return label;
}

nanogui::Button* addButton(Widget* parent, const std::string& text, int width,
                           const std::function<void()>& pressed) {
  auto* button = parent->add<nanogui::Button>(text);
  button->setFixedSize({width, 22});
  button->setFontSize(kFont);
  button->setCallback(pressed);
  return button;
}

nanogui::CheckBox* addCheckBox(Widget* parent, const std::string& text, int width, bool checked,
                               const std::function<void(bool)>& switched) {
  auto* box = parent->add<nanogui::CheckBox>(text);
  box->setFixedSize({width, kLine});
  box->setFontSize(kFont);
  box->setChecked(checked);
  box->setCallback(switched);
  return box;
}

void removeChildren(Widget* parent) {
  parent->screen()->updateFocus(nullptr);
  while (parent->childCount() > 0) parent->removeChild(parent->childCount() - 1);
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
