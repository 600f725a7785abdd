#pragma once
#include <synthetic_world/Image.h>
#include <synthetic_world/World.h>

namespace synthetic_world {

/** Color of a surface in the afternoon sun: texture, light, cast shadow, haze. */
Color surfaceColor(const World& world, const Hit& hit);

/** Color of the sky in a direction of unit length. */
Color skyColor(const Eigen::Vector3d& direction);

/** A world seen straight from above, north (+y) up, x to the right. */
struct TopView {
  Image<Color> color;
  Image<ClassId> labels;
};

/** \param metersPerPixel
 * \throw std::invalid_argument not positive, or so small that an edge has more than 8192 pixels. */
TopView renderTopView(const World& world, double metersPerPixel);

}  // namespace synthetic_world
