#include "Animation.h"

#include <map_pictures/MapCanvas.h>
#include <map_pictures/PictureFiles.h>

#include <cmath>

namespace semantic_map_view {

namespace {

constexpr int kPictures = 72;
constexpr double kPeriod = 0.28;  // s a frame: 20 s in all
/** A share of the leaves that the tree has at first. */
constexpr double kFewest = 0.004;

cv::Mat restingPicture(ViewWindow& window) {
  while (window.drawFrame()) {
  }
  return window.drawPicture();
}

}  // namespace

void animate(ViewWindow& window, CompressPanel& panel, const std::filesystem::path& file) {
  map_pictures::GifFile gif(file, kPeriod);
  panel.switchOn(true);
  panel.setAlpha(0);
  const double most = double(panel.compression()->numLeaves());
  map_view::OrbitCamera camera = window.orbitCamera();
  for (int i = 0; i < kPictures; ++i) {
    const double turned = 2 * M_PI * i / kPictures;
    panel.setLeaves(std::size_t(most * std::pow(kFewest, (1 - std::cos(turned)) / 2)));
    panel.measure();
    window.setOrbitCamera(camera);
    cv::Mat picture = restingPicture(window);
    map_pictures::drawScaleBar(picture, camera.focalLength(window.pixelHeight()) / camera.distance);
    gif.add(picture);
    camera.azimuth += 360.0 / kPictures;
  }
  gif.close();
}

}  // namespace semantic_map_view
