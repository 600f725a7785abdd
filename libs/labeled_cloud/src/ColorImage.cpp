#include <labeled_cloud/Pictures.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>

#include <stdexcept>

namespace labeled_cloud {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationStereoImages;

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
