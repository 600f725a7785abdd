#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>

namespace labeled_cloud {

/** What an image file says of itself before its pixels. */
class ImageHeader {
 public:
  enum class Kind { None, Png, Bmp, Pnm, Tiff, Jpeg };

  /** \throw std::filesystem::filesystem_error there is no such file. */
  explicit ImageHeader(const std::filesystem::path& file);
  /** By the first bytes. None, too: what OpenCV may take for something else. */
  Kind kind() const { return m_kind; }
  /** \throw std::runtime_error more pixels than the file's bytes can hold. */
  void checkSize() const;

 private:
  struct Size {
    std::uint64_t columns = 0, rows = 0;
  };
  bool is(const std::string& text, std::size_t at = 0) const {
    return m_bytes.compare(std::min(at, m_bytes.size()), text.size(), text) == 0;
  }
  Kind kindOfBytes() const;
  Size size() const;
  Size sizeOfPnm() const;
  Size sizeOfTiff() const;
  Size sizeOfJpeg() const;
  /** The number in `bytes` bytes; bytes beyond the end are zeros. */
  std::uint64_t number(std::size_t at, int bytes, bool isHighestFirst) const;
  std::uint64_t nextNumber(std::size_t& at) const;

  std::uintmax_t m_fileSize;
  std::string m_bytes;
  Kind m_kind;
};

}  // namespace labeled_cloud
