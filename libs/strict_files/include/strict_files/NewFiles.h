#pragma once
#include <filesystem>

namespace strict_files {

/** Says that a file is to be new: what others put there from now on is not replaced by this process
 * (StagedFile, OutputFolder). Its own is, once it has its place. */
void declareNew(const std::filesystem::path& file);

}  // namespace strict_files
