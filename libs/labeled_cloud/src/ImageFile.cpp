#include <labeled_cloud/ImageFile.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "PngFile.h"

namespace labeled_cloud {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPng = "\x89PNG";

/** The first bytes of a file, and numbers among them. */
class Beginning {
 public:
  explicit Beginning(const fs::path& file) : m_fileSize(fs::file_size(file)) {
    std::ifstream stream(file, std::ios::binary);
    m_bytes.resize(1024);
    stream.read(m_bytes.data(), static_cast<std::streamsize>(m_bytes.size()));
    m_bytes.resize(static_cast<std::size_t>(stream.gcount()));
  }

  bool is(const std::string& text, std::size_t at = 0) const {
    return m_bytes.compare(std::min(at, m_bytes.size()), text.size(), text) == 0;
  }
  bool isPnm() const {
    return m_bytes.size() > 2 && m_bytes[0] == 'P' && isIn(m_bytes[1], '1', '6');
  }

  struct Size {
    std::uint64_t columns = 0, rows = 0;
  };
  /** What a PNG, BMP or PNM file announces. */
  Size size() const {
    if (is(kPng)) return {number(16, {3, 2, 1, 0}), number(20, {3, 2, 1, 0})};
    if (is("BM")) return {number(18, {0, 1, 2, 3}), number(22, {0, 1, 2, 3})};
    std::size_t at = 2;
    const std::uint64_t columns = nextNumber(at);
    return {columns, nextNumber(at)};
  }
  std::uintmax_t fileSize() const { return m_fileSize; }

 private:
  static bool isIn(char c, char first, char last) { return c >= first && c <= last; }
  /** Four bytes, the lowest first in ORDER. Its absolute value: rows of a BMP file may be counted
   * from above, by a negative number. */
  std::uint64_t number(std::size_t at, const std::array<std::size_t, 4>& order) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      if (at + order[i] < m_bytes.size())
        value |= std::uint32_t(static_cast<unsigned char>(m_bytes[at + order[i]])) << 8 * i;
    return static_cast<std::uint64_t>(std::abs(std::int64_t{static_cast<std::int32_t>(value)}));
  }
  /** Of a PNM file's text, without its comments; at most ten digits. */
  std::uint64_t nextNumber(std::size_t& at) const {
    while (at < m_bytes.size() && !isIn(m_bytes[at], '0', '9'))
      at = m_bytes[at] == '#' ? std::min(m_bytes.find('\n', at), m_bytes.size()) : at + 1;
    std::uint64_t number = 0;
    for (; at < m_bytes.size() && isIn(m_bytes[at], '0', '9'); ++at)
      number = std::min<std::uint64_t>(10 * number + std::uint64_t(m_bytes[at] - '0'), 1u << 31);
    return number;
  }

  std::uintmax_t m_fileSize;
  std::string m_bytes;
};

/** Bytes hold eight packed pixels at most; zlib has 1032 of them in one, BMP's runs 128. */
void checkSize(const Beginning& begin) {
  const std::uint64_t mostEach = 8 * (begin.is(kPng) ? 1032 : 128);
  const auto [columns, rows] = begin.size();
  if (columns * rows > mostEach * begin.fileSize())
    throw std::runtime_error("says that it has " + std::to_string(columns) + " x " +
                             std::to_string(rows) + " pixels, more than its " +
                             std::to_string(begin.fileSize()) + " bytes can hold");
}

void check(const fs::path& file, ImageKinds kinds) {
  if (!fs::is_regular_file(file)) throw std::runtime_error("there is no such file");
  const Beginning begin(file);
  const bool isSized = begin.is(kPng) || begin.is("BM") || begin.isPnm();
  const bool all = kinds == ImageKinds::All;
  const bool isOther = begin.is("II*") || begin.is("MM") || (all && begin.is("\xff\xd8\xff"));
  if ((!isSized && !isOther) || begin.is("DICM", 128))
    throw std::runtime_error(std::string("cannot be read: it is no PNG, ") + (all ? "JPEG, " : "") +
                             "TIFF, BMP or PNM image");
  if (isSized) checkSize(begin);
}

cv::Mat pixelsOf(const fs::path& file) {
  if (Beginning(file).is(kPng)) return readPng(file);
  const cv::Mat pixels = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (pixels.empty()) throw std::runtime_error("cannot be read as an image");
  return pixels;
}

/** With the file's name before the message. */
template <class Action>
auto naming(const fs::path& file, const Action& action) try {
  return action();
} catch (const std::exception& e) {
  throw std::runtime_error(file.string() + ": " + e.what());
}

}  // namespace

void checkImageFile(const fs::path& file, ImageKinds kinds) {
  naming(file, [&] { check(file, kinds); });
}

cv::Mat readImageFile(const fs::path& file, ImageKinds kinds) {
  checkImageFile(file, kinds);
  return naming(file, [&] { return pixelsOf(file); });
}

}  // namespace labeled_cloud
