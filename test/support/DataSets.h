#pragma once
#include <filesystem>
#include <vector>

#include "LabeledFrame.h"

/** A sequence of SemanticKITTI (velodyne/, labels/, poses.txt, calib.txt), classes folded by TABLE.
 */
std::vector<LabeledFrame> readSemanticKitti(const std::filesystem::path& sequence,
                                            const semantic_types::ClassTable& table);

/** The Replica flat as a TUM RGB-D sequence with class images: every pixel with a depth.
 * \param most so many frames of its beginning */
std::vector<LabeledFrame> readReplica(const std::filesystem::path& folder, std::size_t most);
