#pragma once
#include <map_view/CellSource.h>
#include <map_view/OrbitCamera.h>

#include <optional>

namespace map_window {

/** How a window begins. */
struct Beginning {
  /** Without, all of the map is seen. */
  std::optional<map_view::OrbitCamera> camera;
  bool top = false;  ///< from above, north up
  map_view::ViewStyle style;
};

}  // namespace map_window
