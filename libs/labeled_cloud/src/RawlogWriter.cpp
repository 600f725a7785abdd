#include <labeled_cloud/Rawlogs.h>
#include <mrpt/serialization/CArchive.h>

namespace labeled_cloud {

namespace {

/** gzip's level, 1 to 9. Higher levels hardly shrink labeled clouds and take several times longer.
 */
constexpr int kCompression = 2;

}  // namespace

RawlogWriter::RawlogWriter(const std::filesystem::path& file)
    : m_file(file), m_stream(std::make_unique<GzipOutputStream>(m_file.path(), kCompression)) {}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::serialization::CSerializable& object) {
  auto archive = mrpt::serialization::archiveFrom(*m_stream);
  archive << object;
}

void RawlogWriter::finish() {
  m_stream->close();
  m_file.commit();
}

}  // namespace labeled_cloud
