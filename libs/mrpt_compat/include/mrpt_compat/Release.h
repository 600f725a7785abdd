#pragma once
#include <mrpt/version.h>

/** \file
 * Which release of MRPT this is. What differs between them stands in this library; for its
 * navigator, in semantic_driving/src/ReactiveSystem.h; for CMake, in cmake/Dependencies.cmake.
 * Everything else compiles with all of them. */

/** MRPT_VERSION counts 0x258 for 2.5.8, and (major << 16) | (minor << 8) | patch from 2.10.2 on, so
 * that this comparison holds for both. */
#define MSO_MRPT_AT_LEAST(MAJOR, MINOR, PATCH) \
  (MRPT_VERSION >= (((MAJOR) << 16) | ((MINOR) << 8) | (PATCH)))

/** MRPT's objects that are drawn: mrpt::opengl, since MRPT 3 mrpt::viz. */
#if MSO_MRPT_AT_LEAST(3, 0, 0)
namespace mrpt::viz {
class CSetOfObjects;
}
namespace mrpt_compat {
namespace drawing = mrpt::viz;
}
#else
namespace mrpt::opengl {
class CSetOfObjects;
}
namespace mrpt_compat {
namespace drawing = mrpt::opengl;
}
#endif
