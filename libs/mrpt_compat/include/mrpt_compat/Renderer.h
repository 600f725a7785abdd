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

/** Colors in the picture are those of the scene's objects; MRPT 3 makes them lighter otherwise. */
inline void keepColors([[maybe_unused]] Scene& scene) {
#if MSO_MRPT_AT_LEAST(3, 0, 0)
  scene.getViewport()->lightParameters().gamma_correction = false;
#endif
}

}  // namespace mrpt_compat
