#pragma once
#include <map_view/CellSource.h>
#include <map_view/OrbitCamera.h>

#include <optional>

namespace map_view {

/** The first cell along a ray that is shown and occupied: what is seen there, down to the finest
 * cell, whatever the view draws together. */
std::optional<ViewCell> firstShown(const CellSource& cells, const CellLook& look, const Ray& ray);

}  // namespace map_view
