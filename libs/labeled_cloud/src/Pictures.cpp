#include <labeled_cloud/Pictures.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <png.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationStereoImages;

namespace {

namespace fs = std::filesystem;

/** libpng's state. It reports errors by jumping back to the last setjmp(). */
struct Reading {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string problem = "damaged";

  Reading() {
    png = png_create_read_struct(
        PNG_LIBPNG_VER_STRING, this,
        [](png_structp p, png_const_charp message) {
          static_cast<Reading*>(png_get_error_ptr(p))->problem = message;
          png_longjmp(p, 1);
        },
        [](png_structp, png_const_charp) {});
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) throw std::bad_alloc();
  }
  ~Reading() { png_destroy_read_struct(&png, &info, nullptr); }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
};

/** Reads up to the pixels, and has them come as they are, but blue first. \return whether it could
 */
bool readHeader(Reading& reading, std::FILE* file) {
  if (setjmp(png_jmpbuf(reading.png))) return false;
  png_init_io(reading.png, file);
  png_read_info(reading.png, reading.info);
  png_set_packing(reading.png);
  png_set_swap(reading.png);
  png_set_bgr(reading.png);
  png_set_interlace_handling(reading.png);
  png_read_update_info(reading.png, reading.info);
  return true;
}

bool readRows(Reading& reading, png_bytep* rows) {
  if (setjmp(png_jmpbuf(reading.png))) return false;
  png_read_image(reading.png, rows);
  png_read_end(reading.png, nullptr);
  return true;
}

int typeOf(const Reading& reading) {
  const int channels = png_get_channels(reading.png, reading.info);
  const int bits = png_get_bit_depth(reading.png, reading.info);
  if (channels == 2 || (channels > 1 && bits == 16))
    throw std::runtime_error("expected ids of up to 16 bits, a palette, or 8-bit colors");
  return CV_MAKETYPE(bits == 16 ? CV_16U : CV_8U, channels);
}

/** Pixels of a PNG file as they are stored: indices of a palette, gray values of 1 to 16 bits
 * (CV_8UC1, CV_16UC1), or BGR(A) colors. OpenCV would stretch narrow gray values and lose the
 * indices.
 * \param path Its size was checked (checkImageFile()).
 * \throw std::runtime_error it is damaged, or has pixels of another kind. */
cv::Mat readPng(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) throw std::runtime_error("cannot be opened");
  Reading reading;
  if (!readHeader(reading, file.get())) throw std::runtime_error(reading.problem);
  cv::Mat pixels(static_cast<int>(png_get_image_height(reading.png, reading.info)),
                 static_cast<int>(png_get_image_width(reading.png, reading.info)), typeOf(reading));
  std::vector<png_bytep> rows;
  for (int row = 0; row < pixels.rows; ++row) rows.push_back(pixels.ptr(row));
  if (!readRows(reading, rows.data())) throw std::runtime_error(reading.problem);
  return pixels;
}

/** What an image file says of itself before its pixels. */
class ImageHeader {
 public:
  enum class Kind { None, Png, Jpeg };

  /** \throw std::filesystem::filesystem_error there is no such file. */
  explicit ImageHeader(const std::filesystem::path& file)
      : m_fileSize(std::filesystem::file_size(file)) {
    std::ifstream stream(file, std::ios::binary);
    const auto read = [&](std::uintmax_t bytes) {
      const std::size_t before = m_bytes.size();
      m_bytes.resize(std::max<std::size_t>(before, std::min(m_fileSize, bytes)));
      stream.read(&m_bytes[before], static_cast<std::streamsize>(m_bytes.size() - before));
      m_bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
    };
    read(1024);
    m_kind = kindOfBytes();
    if (m_kind == Kind::Jpeg) read(m_fileSize);  // it may stand anywhere
  }
  /** By the first bytes. None, too: what OpenCV may take for something else. */
  Kind kind() const { return m_kind; }
  /** A byte of a mask of one class stands for up to 900 pixels: panoramas are allowed in any case.
   * JPEG takes up to nine bytes a pixel.
   * \throw std::runtime_error it has more pixels than that and kPerByte for each byte. */
  void checkSize() const {
    constexpr std::uint64_t kPerByte = 16;
    const std::uint64_t most = (m_kind == Kind::Png ? 16384 : 8192) * 8192;
    const auto [columns, rows] = size();
    if (columns > 0 && rows > (most + kPerByte * m_fileSize) / columns)
      throw std::runtime_error("says that it has " + std::to_string(columns) + " x " +
                               std::to_string(rows) + " pixels, more than a file of " +
                               std::to_string(m_fileSize) + " bytes may have");
  }

 private:
  struct Size {
    std::uint64_t columns = 0, rows = 0;
  };
  bool is(const std::string& text, std::size_t at = 0) const {
    return m_bytes.compare(std::min(at, m_bytes.size()), text.size(), text) == 0;
  }
  Kind kindOfBytes() const {
    if (is("DICM", 128)) return Kind::None;
    if (is("\x89PNG")) return Kind::Png;
    return is("\xff\xd8\xff") ? Kind::Jpeg : Kind::None;
  }
  Size size() const {
    if (m_kind == Kind::Png) return {number(16, 4), number(20, 4)};
    return m_kind == Kind::Jpeg ? sizeOfJpeg() : Size();
  }
  /** From the header of the frame (ITU-T T.81, B.2.2): it has one of the markers C0 to CF that is
   * no table. Markers 01 and D0 to D7 have no length; bytes between segments are skipped, as by
   * libjpeg. */
  Size sizeOfJpeg() const {
    for (std::size_t at = 2; at + 9 < m_bytes.size();) {
      const std::uint64_t marker = number(at + 1, 1);
      if (number(at, 1) != 0xff || marker == 0 || marker == 0xff) {
        ++at;
        continue;
      }
      const bool isTable = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
      if (marker >= 0xc0 && marker <= 0xcf && !isTable)
        return {number(at + 7, 2), number(at + 5, 2)};
      const bool hasLength = marker != 1 && (marker < 0xd0 || marker > 0xd7);
      at += 2 + (hasLength ? number(at + 2, 2) : 0);
    }
    return {};
  }
  /** The number in `bytes` bytes, the highest first; bytes beyond the end are zeros. */
  std::uint64_t number(std::size_t at, std::size_t bytes) const {
    std::uint64_t value = 0;
    for (std::size_t from = at; from < at + bytes; ++from)
      value = value << 8 | (from < m_bytes.size() ? static_cast<unsigned char>(m_bytes[from]) : 0);
    return value;
  }

  std::uintmax_t m_fileSize;
  std::string m_bytes;
  Kind m_kind;
};

void check(const fs::path& file, ImageKinds kinds) {
  if (!fs::is_regular_file(file)) throw std::runtime_error("there is no such file");
  const ImageHeader header(file);
  const bool all = kinds == ImageKinds::All;
  if (header.kind() == ImageHeader::Kind::None ||
      (!all && header.kind() == ImageHeader::Kind::Jpeg))
    throw std::runtime_error(std::string("cannot be read: it is no PNG ") +
                             (all ? "or JPEG image" : "image"));
  header.checkSize();
}

cv::Mat pixelsOf(const fs::path& file) {
  if (ImageHeader(file).kind() == ImageHeader::Kind::Png) return readPng(file);
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

bool isPicture(const CObservation& observation) {
  return dynamic_cast<const CObservationImage*>(&observation) ||
         dynamic_cast<const CObservationStereoImages*>(&observation);
}

ColorImage colorImageOf(const CObservation& observation) {
  if (const auto* o = dynamic_cast<const CObservationImage*>(&observation))
    return {o->image, o->cameraParams, o->cameraPose};
  if (const auto* o = dynamic_cast<const CObservationStereoImages*>(&observation))
    return {o->imageLeft, o->leftCamera, mrpt::poses::CPose3D(o->cameraPose)};
  const auto* o = dynamic_cast<const CObservation3DRangeScan*>(&observation);
  if (!o || !o->hasIntensityImage) throw std::invalid_argument("it has no color image");
  return {o->intensityImage, o->cameraParamsIntensity,
          o->sensorPose + o->relativePoseIntensityWRTDepth};
}

}  // namespace labeled_cloud
