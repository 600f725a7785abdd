#pragma once
#include <map_view/CellSource.h>
#include <nanogui/nanogui.h>
#include <semantic_types/ClassTable.h>

#include <functional>
#include <string>
#include <vector>

namespace map_window {

nanogui::Color colorOf(const semantic_types::Color& color);

/** Widgets below each other under a title. A click on the title folds them. */
class Panel : public nanogui::Window {
 public:
  Panel(nanogui::Widget* parent, const std::string& title, int width);
  /** To put widgets into. */
  nanogui::Widget* content() { return m_content; }
  bool isOpen() const { return m_content->visible(); }
  void open(bool isOpen) { m_content->setVisible(isOpen); }
  /** Called when a hand has opened it. */
  void onOpened(const std::function<void()>& f) { m_onOpened = f; }
  nanogui::Vector2i preferredSize(NVGcontext* context) const override;
  void draw(NVGcontext* context) override;
  bool mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int modifiers) override;

 private:
  nanogui::Widget* m_content;
  std::function<void()> m_onOpened = [] {};
};

/** A line of a bar chart. */
struct Bar {
  std::string name, value;
  double share = 0;  ///< of the width, 0 to 1
  semantic_types::Color color;
};

/** Names, bars and values, one below the other. */
class BarChart : public nanogui::Widget {
 public:
  explicit BarChart(nanogui::Widget* parent) : nanogui::Widget(parent) {}
  void setBars(std::vector<Bar> bars) { m_bars = std::move(bars); }
  nanogui::Vector2i preferredSize(NVGcontext*) const override;
  void draw(NVGcontext* context) override;

 private:
  std::vector<Bar> m_bars;
};

/** What the colors of a map mean, from one end to the other. */
class ScaleBar : public nanogui::Widget {
 public:
  explicit ScaleBar(nanogui::Widget* parent) : nanogui::Widget(parent) {}
  void setScale(const map_view::ColorScale& scale) { m_scale = scale; }
  nanogui::Vector2i preferredSize(NVGcontext*) const override;
  void draw(NVGcontext* context) override;

 private:
  map_view::ColorScale m_scale;
};

/** A square of one color. */
class Swatch : public nanogui::Widget {
 public:
  Swatch(nanogui::Widget* parent, const semantic_types::Color& color);
  void draw(NVGcontext* context) override;

 private:
  nanogui::Color m_color;
};

/** A widget whose children stand beside each other. */
nanogui::Widget* addRow(nanogui::Widget* parent, int spacing = 6);

/** A widget whose children stand below each other. */
nanogui::Widget* addColumn(nanogui::Widget* parent, int margin, int spacing);

/** A part of a panel that scrolls, with its contents below each other. */
nanogui::Widget* addScroll(nanogui::Widget* parent, int width, int height);

/** A line of text of a fixed width. */
nanogui::Label* addText(nanogui::Widget* parent, const std::string& text, int width);

/** A text of as many lines as it needs. */
nanogui::Label* addLines(nanogui::Widget* parent, int width);

nanogui::Button* addButton(nanogui::Widget* parent, const std::string& text, int width,
                           const std::function<void()>& pressed);

nanogui::CheckBox* addCheckBox(nanogui::Widget* parent, const std::string& text, int width,
                               bool checked, const std::function<void(bool)>& switched);

/** Takes out all children; none of them keeps the keyboard. */
void removeChildren(nanogui::Widget* parent);

nanogui::Slider* addSlider(nanogui::Widget* parent, int width, float low, float high, float value,
                           const std::function<void(float)>& moved);

}  // namespace map_window
