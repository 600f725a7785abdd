#pragma once
#include <strict_files/OptionList.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace some {

enum class Color { DarkRed, Green };
inline const strict_files::Choices<Color>& choicesOf(Color) {
  static const strict_files::Choices<Color> choices = {{"dark_red", Color::DarkRed},
                                                       {"green", Color::Green}};
  return choices;
}

/** An option of each kind. */
struct Options {
  double length = 2;
  double gap = std::numeric_limits<double>::infinity();
  int count = 3;
  std::uint8_t small = 7;
  bool on = true, off = false;
  Color color = Color::Green;
  std::string title = "a title";
  std::optional<double> floor;
  Eigen::Vector3d place{1, 2, 3};

  void describe(strict_files::OptionList& list) {
    using strict_files::above;
    using strict_files::atLeast;
    list.add("length", length, "m", above(0).upTo(10), "how long");
    list.add("max_gap", gap, "s", atLeast(0).orInfinite(), "how long without");
    list.add("count", count, "", atLeast(1), "how many");
    list.add("small", small, "", "how few");
    list.add("on", on, "", "switched on");
    list.add("off", off, "", "switched off");
    list.add("color", color, "", "which color");
    list.add("title", title, "", "what it is called");
    list.add("floor", floor, "m", strict_files::Range().below(5), "how low");
    list.add("place", place, "m", "where");
  }
  void validate() const { strict_files::checkOptions(*this, "Options"); }
};

}  // namespace some
