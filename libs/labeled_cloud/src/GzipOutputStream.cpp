#include <labeled_cloud/Rawlogs.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>

namespace labeled_cloud {

GzipOutputStream::GzipOutputStream(const std::filesystem::path& file, int compression)
    : m_path(file) {
  const std::string mode = "wb" + std::to_string(compression);
  m_file = gzopen(file.c_str(), mode.c_str());
  if (!m_file) fail();
}

GzipOutputStream::~GzipOutputStream() {
  if (m_file) gzclose_w(m_file);
}

std::size_t GzipOutputStream::Write(const void* buffer, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const auto piece = static_cast<unsigned>(std::min<std::size_t>(count - done, 1u << 30));
    const int written = gzwrite(m_file, static_cast<const char*>(buffer) + done, piece);
    if (written <= 0) fail();
    done += written;
  }
  m_taken += count;
  return count;
}

void GzipOutputStream::close() {
  const int result = gzclose_w(m_file);
  m_file = nullptr;
  if (result != Z_OK) fail();
}

void GzipOutputStream::fail() const {
  throw std::runtime_error(m_path.string() + ": cannot be written (is the disk full?)");
}

std::size_t GzipOutputStream::Read(void*, std::size_t) {
  throw std::logic_error("GzipOutputStream: cannot be read from");
}

std::uint64_t GzipOutputStream::Seek(std::int64_t, TSeekOrigin) {
  throw std::logic_error("GzipOutputStream: cannot seek");
}

}  // namespace labeled_cloud
