#pragma once
#include "Config.h"

namespace rawlog2semantic_map {

/** Whether a section describes a camera: [camera NAME]. */
bool isCameraSection(const std::string& section);

/** Reads [labels], [cameras] and all [camera NAME].
 * \throw std::runtime_error naming section, key and value. */
void readLabelConfig(const mrpt::config::CConfigFileBase& ini, Config& config);

}  // namespace rawlog2semantic_map
