#pragma once
#include <vector>

namespace synthetic_world {

/** Pixels row by row, from the upper left. */
template <class T>
struct Image {
  int width = 0, height = 0;
  std::vector<T> pixels;

  Image() = default;
  Image(int w, int h, T value = T())
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, value) {}
  bool empty() const { return pixels.empty(); }
  T& at(int row, int column) { return pixels[static_cast<std::size_t>(row) * width + column]; }
  const T& at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * width + column];
  }
};

}  // namespace synthetic_world
