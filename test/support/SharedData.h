#pragma once
#include <cstdlib>
#include <filesystem>

/** Folder of the real data sets that are not part of this repository (see test/README.md): the
 * environment variable SEMANTIC_OCTREE_DATA, or ../shared/data beside the sources. Empty if absent.
 */
inline std::filesystem::path sharedDataDir() {
  namespace fs = std::filesystem;
  const char* variable = std::getenv("SEMANTIC_OCTREE_DATA");
  const fs::path dir = variable ? fs::path(variable) : fs::path(MSO_SOURCE_DIR) / "../shared/data";
  return fs::is_directory(dir) ? dir : fs::path();
}

/** Skips the running test, saying so, where FOLDER of the real data is absent. */
#define SKIP_WITHOUT_DATA(FOLDER)                                                      \
  if (sharedDataDir().empty() || !std::filesystem::exists(sharedDataDir() / (FOLDER))) \
  GTEST_SKIP() << "needs the data set '" << (FOLDER) << "' (set SEMANTIC_OCTREE_DATA)"
