#pragma once
#include <mrpt/opengl/CFBORender.h>
#include <mrpt_compat/Drawing.h>

namespace mrpt_compat {

/** Sets where a scene that is drawn next is seen from. */
inline void setCamera(mrpt::opengl::CFBORender& renderer, [[maybe_unused]] const Scene& scene,
                      const drawing::CCamera& camera) {
#if MSO_MRPT_AT_LEAST(3, 0, 0)
  renderer.setCamera(camera);
#else
  renderer.setCamera(scene, camera);
#endif
}

}  // namespace mrpt_compat
