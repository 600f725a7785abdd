#include <labeled_cloud/Rawlogs.h>
#include <mrpt/serialization/CArchive.h>
#include <semantic_map/MapFiles.h>

namespace semantic_map {

void writeScene(const mrpt_compat::Scene& scene, const std::filesystem::path& file) {
  constexpr int kCompression = 2;  // of 1 to 9
  labeled_cloud::GzipOutputStream stream(file, kCompression);
  mrpt::serialization::archiveFrom(stream) << scene;
  stream.close();
}

}  // namespace semantic_map
