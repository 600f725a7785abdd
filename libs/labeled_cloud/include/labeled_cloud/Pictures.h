#pragma once
#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace cv {
class Mat;
}

namespace labeled_cloud {

/** Which kinds of image files are read. */
enum class ImageKinds {
  Lossless,  ///< PNG: values of pixels that mean something
  All        ///< JPEG, too
};

/** The pixels of an image file as they are stored, its kind told by its first bytes. (OpenCV tries
 * its decoders in turn: it takes some files of one kind for another, and ends the process over
 * damaged ones.) Colors are BGR(A).
 * \throw std::runtime_error naming the file: there is none, it is no image, it is damaged, or it
 * has more pixels than 16384 x 8192 (JPEG: 8192 x 8192) and 16 for each byte. */
cv::Mat readImageFile(const std::filesystem::path& file, ImageKinds kinds);

/** What readImageFile() looks at before it reads the pixels, for those who have others read them.
 * \throw std::runtime_error as readImageFile(). */
void checkImageFile(const std::filesystem::path& file, ImageKinds kinds);

/** A color (or gray) image of an observation, with the camera that took it. */
struct ColorImage {
  /** Shares its pixels with the observation; may be stored in a file of its own. */
  mrpt::img::CImage image;
  mrpt::img::TCamera camera;
  /** The camera's optical frame: x right, y down, z forward. */
  mrpt::poses::CPose3D T_robot_camera;
};

/** Whether observations of this class are nothing but pictures: CObservationImage and
 * CObservationStereoImages (of which the left image counts). */
bool isPicture(const mrpt::obs::CObservation& observation);

/** The color image of a picture, or of a CObservation3DRangeScan that has one.
 * \throw std::invalid_argument the observation has none. */
ColorImage colorImageOf(const mrpt::obs::CObservation& observation);

/** How many pixels a point in front must shift against one behind it, between the sensor's and the
 * camera's view, to hide it. */
constexpr double kOcclusionParallax = 1.5;

/** The pixel (column, row) at which a camera sees each point; NaN for points outside of the image,
 * behind the camera, not finite, or hidden.
 *
 * A point may be hidden if the sensor is at a distance b from the camera. From it two points at
 * depths z and Z on one ray of the camera are b f (1/z - 1/Z) pixels apart. What hides a point is
 * another one within twice the points' spacing in the image. It is nearer by more than PARALLAX
 * such pixels, for one that is nearer by less leaves no more than that along its edge. It is also
 * nearer by more than a surface that passes the camera at one meter changes within that distance.
 * \param T_camera_points The camera's optical frame: x right, y down, z forward. \param parallax
 * pixels; 0: nothing is hidden. \throw std::invalid_argument the camera is not calibrated. */
std::vector<Eigen::Vector2f> visiblePixels(const std::vector<Eigen::Vector3f>& points,
                                           const Eigen::Isometry3d& T_camera_points,
                                           const mrpt::img::TCamera& camera, double parallax);

}  // namespace labeled_cloud
