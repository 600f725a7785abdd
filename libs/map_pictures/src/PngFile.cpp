#include <map_pictures/PictureFiles.h>
#include <png.h>
#include <strict_files/OutputFiles.h>
#include <zlib.h>

#include <csetjmp>
#include <cstdio>
#include <stdexcept>

namespace map_pictures {

/** libpng's state. It reports errors by jumping back to the last setjmp(): functions that call it
 * have nothing to destroy. */
struct PngFile::Writing {
  Writing(const std::filesystem::path& path, const cv::Size& pixels)
      : name(path.string()),
        staged(path),
        size(pixels),
        file(std::fopen(staged.path().c_str(), "wb"), std::fclose) {
    if (!file) fail();
    png = png_create_write_struct(
        PNG_LIBPNG_VER_STRING, nullptr, [](png_structp p, png_const_charp) { png_longjmp(p, 1); },
        [](png_structp, png_const_charp) {});
    info = png ? png_create_info_struct(png) : nullptr;
    if (!info) throw std::bad_alloc();
  }
  ~Writing() { png_destroy_write_struct(&png, &info); }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;

  [[noreturn]] void fail() const { throw std::runtime_error("cannot write '" + name + "'"); }

  /** Settings are those of OpenCV's pictures. \return whether it could */
  bool writeHeader() {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file.get());
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png, Z_BEST_SPEED);
    png_set_compression_strategy(png, Z_RLE);
    png_set_IHDR(png, info, png_uint_32(size.width), png_uint_32(size.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    png_set_bgr(png);
    return true;
  }
  bool writeRow(const std::uint8_t* row) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_write_row(png, row);
    return true;
  }
  bool writeEnd() {
    if (setjmp(png_jmpbuf(png))) return false;
    png_write_end(png, info);
    return true;
  }

  std::string name;
  strict_files::StagedFile staged;
  cv::Size size;
  int done = 0;  ///< rows
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

PngFile::PngFile(const std::filesystem::path& file, const cv::Size& size)
    : m(std::make_unique<Writing>(file, size)) {
  if (!m->writeHeader()) m->fail();
}

PngFile::~PngFile() = default;

void PngFile::add(const cv::Mat& rows) {
  if (rows.type() != CV_8UC3 || rows.cols != m->size.width || rows.rows > m->size.height - m->done)
    throw std::invalid_argument("PNG: rows that are not of the picture");
  for (int i = 0; i < rows.rows; ++i)
    if (!m->writeRow(rows.ptr(i))) m->fail();
  m->done += rows.rows;
}

void PngFile::close() {
  if (m->done != m->size.height) throw std::invalid_argument("PNG: rows are missing");
  if (!m->writeEnd()) m->fail();
  if (std::fclose(m->file.release()) != 0) m->fail();
  m->staged.commit();
}

}  // namespace map_pictures
