#pragma once
#include <mrpt_compat/Drawing.h>

#include "Track.h"
#include "map_window/ViewWindow.h"

namespace semantic_map_view {

/** m above the ground: of what is drawn upon the map. */
constexpr float kLift = 0.3f;

/** Some pixels where the window looks at now, m. */
float bandWidth(const map_window::ViewWindow& window);

/** Flat, with a light border: dark where it goes forward, orange backward, blue where that is not
 * known, as in the pictures of plans. (Many drivers draw lines one pixel wide whatever they are
 * asked for.) \param width m */
mrpt_compat::drawing::CSetOfTriangles::Ptr bandAlong(const std::vector<Track::Point>& points,
                                                     float width);

}  // namespace semantic_map_view
