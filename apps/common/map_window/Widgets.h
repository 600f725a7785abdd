#pragma once
#include <nanogui/nanogui.h>
#include <semantic_types/ClassTable.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace map_window {

nanogui::Color colorOf(const semantic_types::Color& color);

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

/** Rows of a name and of numbers below each other. */
class Table : public nanogui::Widget {
 public:
  /** \param nameWidth, columnWidth pixels */
  Table(nanogui::Widget* parent, int nameWidth, int columnWidth)
      : nanogui::Widget(parent), m_nameWidth(nameWidth), m_columnWidth(columnWidth) {}
  void setRows(std::vector<std::vector<std::string>> rows) { m_rows = std::move(rows); }
  void draw(NVGcontext* context) override;

 private:
  int m_nameWidth, m_columnWidth;
  std::vector<std::vector<std::string>> m_rows;
};

/** Names below each other, which the hand puts into another order. */
class OrderList : public nanogui::Widget {
 public:
  /** \param moved called with the indices of the names of setNames(), in their new order */
  using Moved = std::function<void(const std::vector<std::size_t>&)>;
  OrderList(nanogui::Widget* parent, const Moved& moved)
      : nanogui::Widget(parent), m_moved(moved) {}
  void setNames(std::vector<std::string> names);
  nanogui::Vector2i preferredSize(NVGcontext*) const override;
  void draw(NVGcontext* context) override;
  bool mouseButtonEvent(const nanogui::Vector2i& p, int button, bool down, int) override;
  bool mouseDragEvent(const nanogui::Vector2i& p, const nanogui::Vector2i&, int, int) override;

 private:
  std::size_t lineAt(const nanogui::Vector2i& p) const;

  Moved m_moved;
  std::vector<std::string> m_names;
  std::vector<std::size_t> m_order, m_before;
  std::optional<std::size_t> m_held;  ///< line
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

/** A line of text of a fixed width. */
nanogui::Label* addText(nanogui::Widget* parent, const std::string& text, int width);

nanogui::CheckBox* addCheckBox(nanogui::Widget* parent, const std::string& text, int width);

/** Takes out all children; none of them keeps the keyboard. */
void removeChildren(nanogui::Widget* parent);

/** A window whose children stand below each other. */
nanogui::Window* addWindow(nanogui::Widget* parent, const std::string& title,
                           const nanogui::Vector2i& place, int width);

nanogui::Slider* addSlider(nanogui::Widget* parent, int width, float low, float high, float value,
                           const std::function<void(float)>& moved);

}  // namespace map_window
