#include <map_pictures/MapCanvas.h>
#include <strict_files/StagedFile.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace map_pictures {
namespace {

void require(bool fine, const char* what, double value, const char* expected) {
  if (!fine)
    throw std::invalid_argument(std::string("picture: ") + what + " is " + std::to_string(value) +
                                ", expected " + expected);
}

}  // namespace

void PictureStyle::validate() const {
  constexpr int kMost = 16384;
  require(width >= 200 && width <= kMost, "width", width, "200 to 16384 pixels");
  require(height >= 200 && height <= kMost, "height", height, "200 to 16384 pixels");
  require(minOccupancy >= 0 && minOccupancy < 1, "minOccupancy", minOccupancy, "0 to less than 1");
  require(!maxHeight || !std::isnan(*maxHeight), "maxHeight", maxHeight.value_or(0), "a number");
}

void Viewpoint::validate() const {
  require(std::isfinite(heading), "heading", heading, "a finite angle");
  require(tilt > 0 && tilt <= 90, "tilt", tilt, "above 0, up to 90 degrees");
  require(std::isfinite(zoom) && zoom > 0, "zoom", zoom, "above 0");
}

cv::Mat renderTopView(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style) {
  const MapCanvas canvas = MapCanvas::ofMap(tree, style);
  return style.legend ? canvas.sheet(style.title) : canvas.withScale();
}

void savePicture(const cv::Mat& picture, const std::filesystem::path& file) {
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", picture, png))
    throw std::runtime_error("cannot encode the picture for '" + file.string() + "'");
  strict_files::StagedFile staged(file);
  std::ofstream out(staged.path(), std::ios::binary);
  out.write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  out.close();
  if (!out) throw std::runtime_error("cannot write '" + file.string() + "'");
  staged.commit();
}

}  // namespace map_pictures
