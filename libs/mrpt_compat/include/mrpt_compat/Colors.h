#pragma once
#include <mrpt/img/color_maps.h>
#include <mrpt_compat/Release.h>

namespace mrpt_compat {

/** A color of one of MRPT's color maps. \param share where in it, 0 to 1 */
inline mrpt::img::TColor colorAt(mrpt::img::TColormap map, double share) {
#if MSO_MRPT_AT_LEAST(3, 0, 0)
  return mrpt::img::colormap(map, static_cast<float>(share)).asTColor();
#else
  return mrpt::img::colormap(map, share);
#endif
}

/** \param hue, saturation, value 0 to 1 */
inline mrpt::img::TColorf colorOfHue(float hue, float saturation, float value) {
#if MSO_MRPT_AT_LEAST(3, 0, 0)
  return mrpt::img::hsv2rgb(hue, saturation, value);
#else
  mrpt::img::TColorf color;
  mrpt::img::hsv2rgb(hue, saturation, value, color.R, color.G, color.B);
  return color;
#endif
}

}  // namespace mrpt_compat
