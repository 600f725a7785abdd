#include <labeled_cloud/Pictures.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "ImageHeader.h"
#include "PngFile.h"

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationStereoImages;

namespace {

namespace fs = std::filesystem;

void check(const fs::path& file, ImageKinds kinds) {
  if (!fs::is_regular_file(file)) throw std::runtime_error("there is no such file");
  const ImageHeader header(file);
  const bool all = kinds == ImageKinds::All;
  if (header.kind() == ImageHeader::Kind::None ||
      (!all && header.kind() == ImageHeader::Kind::Jpeg))
    throw std::runtime_error(std::string("cannot be read: it is no PNG, ") + (all ? "JPEG, " : "") +
                             "TIFF, BMP or PNM image");
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
