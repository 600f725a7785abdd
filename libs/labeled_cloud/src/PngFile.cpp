#include "PngFile.h"

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace labeled_cloud {
namespace {

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

}  // namespace

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

}  // namespace labeled_cloud
