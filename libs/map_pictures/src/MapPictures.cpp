#include <map_pictures/MapCanvas.h>
#include <strict_files/OutputFiles.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace map_pictures {

using strict_files::above;
using strict_files::between;
using strict_files::checkOptions;
using strict_files::OptionList;

void PictureStyle::describe(OptionList& list) {
  constexpr int kMost = 16384;
  list.add("width", width, "pixels", between(200, kMost), "of the picture without its legend");
  list.add("height", height, "pixels", between(200, kMost), "of the picture");
  list.add("max_height", maxHeight, "m", strict_files::Range().orInfinite(),
           "higher cells are not drawn; none: all but the ceiling of an indoor map");
  list.add("max_above_ground", maxAboveGround, "m", above(0),
           "cells that are higher above the ground are not drawn; none: all");
  list.add("neighbor_weight", neighborWeight, "", between(0, 1),
           "what a voxel across a face tells about a voxel's class, beside 1 for itself; 0: "
           "nothing, 0.4: pictures of noisy labels become clear");
}

void PictureStyle::validate() const { checkOptions(*this, "PictureStyle"); }

void Viewpoint::describe(OptionList& list) {
  list.add("heading", heading, "degrees",
           "direction in which the perspective looks, from +x towards +y");
  list.add("tilt", tilt, "degrees", above(0).upTo(90), "how far it looks down");
}

void Viewpoint::validate() const { checkOptions(*this, "Viewpoint"); }

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
