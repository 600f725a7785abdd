#pragma once
#include "Config.h"

namespace rawlog2semantic_map {

/** The sections that describe a camera: [camera NAME]. */
constexpr const char* kCameraSections = "camera *";

/** Reads [labels], [cameras] and all [camera NAME].
 * \throw std::runtime_error naming section, key and value. */
void readLabelConfig(const mrpt::config::CConfigFileBase& ini, Config& config);

}  // namespace rawlog2semantic_map
