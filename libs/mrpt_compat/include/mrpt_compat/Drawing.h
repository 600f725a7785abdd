#pragma once
#include <mrpt/opengl/CFBORender.h>
#include <mrpt_compat/Release.h>

#if MSO_MRPT_AT_LEAST(3, 0, 0)
#include <mrpt/viz/CBox.h>
#include <mrpt/viz/CCylinder.h>
#include <mrpt/viz/COctoMapVoxels.h>
#include <mrpt/viz/CPointCloud.h>
#include <mrpt/viz/CPolyhedron.h>
#include <mrpt/viz/CSetOfLines.h>
#include <mrpt/viz/CSetOfObjects.h>
#include <mrpt/viz/CSetOfTriangles.h>
#include <mrpt/viz/Scene.h>
#else
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CPolyhedron.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#endif

namespace mrpt_compat {

#if MSO_MRPT_AT_LEAST(3, 0, 0)
using Scene = mrpt::viz::Scene;
#else
using Scene = mrpt::opengl::COpenGLScene;
#endif

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
