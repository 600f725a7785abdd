#pragma once
#include <mrpt_compat/Drawing.h>

#include <filesystem>

namespace semantic_map {

/** Fills a file with a scene for MRPT's viewers (.3Dscene). Unlike the scene's own function it
 * tells when the disk is full. \throw std::runtime_error naming the file. */
void writeScene(const mrpt_compat::Scene& scene, const std::filesystem::path& file);

}  // namespace semantic_map
