#pragma once
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/Pictures.h>
#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/poses/CPose3D.h>
#include <semantic_types/ClassTable.h>
#include <semantic_types/LabeledCloud.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace labeled_cloud {

/** What became of an observation's pixels or points. */
struct ScanCounts {
  /** Points in the cloud, and those of them with a class. */
  std::size_t points = 0, labeled = 0;
  /** Pixels or points without a usable range: zero, NaN, infinite. */
  std::size_t invalid = 0;
  /** Points left out because they hang in the air at a depth edge. */
  std::size_t flying = 0;
};

/** A picture that points took their labels from. */
struct LabeledPicture {
  /** Empty if there is no color image of the label image's view. */
  mrpt::img::CImage image;
  LabelImage labels;
  mrpt::img::TCamera camera;
  /** The camera's optical frame (x right, y down, z forward) when the picture was taken, in that of
   * the sensor when it saw the points. */
  mrpt::poses::CPose3D T_sensor_camera;
};

/** One observation, ready for a map. */
struct LabeledScan {
  /** Points in the sensor's frame, all finite. */
  semantic_types::LabeledCloud cloud;
  /** When each point was taken, seconds after `timestamp`; empty: nobody knows. */
  std::vector<float> times;
  /** Where beams without a return would end: beyond emptyFrom, m. Sensor's frame; only with
   * ScanConverterOptions::emptyCarves. */
  std::vector<Eigen::Vector3f> empty;
  double emptyFrom = std::numeric_limits<double>::infinity();
  mrpt::poses::CPose3D T_robot_sensor;
  mrpt::Clock::time_point timestamp;
  std::string sensorLabel;
  ScanCounts counts;
  /** A labeler was asked and had no labels for this observation. */
  bool labelsMissing = false;
  /** Where the labels come from, if that was asked for. */
  std::vector<LabeledPicture> pictures;

  /** The points, and those of `empty` without a class: with emptyFrom as the largest range these
   * only carve. */
  semantic_types::LabeledCloud withEmpty() const;
  /** Brings counts.labeled up to date. */
  void countLabels();
};

/** Points in the sensor's frame, meters; what was no return is (0, 0, 0) or not finite. Class id i
 * is called classNames[i - 1]; without names the ids are those of the user's class table. */
struct NamedCloud {
  semantic_types::LabeledCloud cloud;
  std::vector<std::string> classNames;
  /** Colors of points without classes, one for each or none: they stand for classes if each is a
   * color of the user's table, or black, which is no class. */
  std::vector<semantic_types::Color> colors;
  /** Raw ids of the user's class table, one for each point; none: the cloud's own classes count. */
  std::vector<std::uint32_t> rawIds = {};
  /** As LabeledScan::times. */
  std::vector<float> times = {};
  /** As CObservationLabeledCloud::emptyFrom. */
  double emptyFrom = std::numeric_limits<double>::infinity();
};

/** A raw id that a field of points or pixels has as a number.
 * \throw std::invalid_argument naming what is no whole number of 32 bits. */
std::uint32_t rawIdOf(double number);
/** ClassTable::fromRaw() for fields of points and pixels, where 0 is no class unless the table
 * folds it. */
semantic_types::ClassId classOfRawId(std::uint32_t rawId, const semantic_types::ClassTable& table);
/** Times of a scan's points. None if one is more than a second from the scan: who wrote them means
 * something else. \param seconds after the scan's time */
std::vector<float> timesOfPoints(const std::vector<double>& seconds);

/** Reads the points of some classes of observations. ScanConverter knows labeled clouds, point
 * clouds, Velodyne packets and plane scanners by such sources; others are added. */
class PointSource {
 public:
  virtual ~PointSource() = default;
  virtual bool accepts(const mrpt::obs::CObservation& observation) const = 0;
  /** The points of an observation that it accepts, and that is loaded. Threads may ask at once.
   * \throw std::exception why it cannot be used */
  virtual NamedCloud read(const mrpt::obs::CObservation& observation) const = 0;
};

/** Every ScanConverter takes from now on what this source accepts; the one added last is asked
 * first. A library that MRPT loads calls this beside mrpt::rtti::registerClass(). Any thread may.
 */
void addPointSource(std::shared_ptr<const PointSource> source);

class PixelRays;
struct PointGrid;

struct ScanConverterOptions {
  /** Depth images: one point for each block of this many pixels squared, the block's nearest; it
   * keeps the label of its own pixel. */
  int decimation = 1;
  /** Depth images: leave out pixels between a front and a rear surface, farther from both than this
   * share of their depth. 0: keep all. */
  double flyingPixelThreshold = 0;
  /** Depth images with labels in a color image of another camera, see visiblePixels(). Without a
   * name in files. */
  double occlusionParallax = kOcclusionParallax;
  /** Depth images, plane scanners and labeled clouds: beams without a return carve up to the range
   * that the observation states, beyond which nothing is seen. */
  bool emptyCarves = false;
  /** What the labels say. */
  LabelModel labels;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** Makes labeled clouds of observations.
 *
 * - CObservation3DRangeScan: the range image, each point with the label of its pixel in the image
 *   that the labels belong to. In a color image of another camera that is the pixel it is projected
 *   to; points outside of it or hidden have no class.
 *   Labels come from the ImageLabeler given, else from the observation's pixelLabels, which are
 *   those of the depth image.
 * - CObservationLabeledCloud: as it is. Where it names its classes, they are found by name in the
 *   class table; otherwise its class ids are those of the table.
 * - CObservationPointCloud: its field "label" (MRPT 2.15) has raw ids of the class table, or its
 *   colors are those of classes; otherwise its points have no class.
 * - CObservationVelodyneScan, CObservation2DRangeScan: points without a class, which count for
 *   occupancy only.
 * - What a PointSource that was added accepts.
 *
 * Externally stored data is loaded, and unloaded at the end. */
class ScanConverter {
 public:
  explicit ScanConverter(const semantic_types::ClassTable& table,
                         const ScanConverterOptions& options = {},
                         std::shared_ptr<ImageLabeler> labeler = nullptr);
  ~ScanConverter();

  /** Whether convert() makes a scan of observations of this class. */
  static bool accepts(const mrpt::obs::CObservation& observation);

  /** The observation's scan, or nothing if it is of another class than those above.
   * \throw std::runtime_error why an observation cannot be used: no range data, no calibration,
   * labels of another size than their image, an unknown class, a missing external file. */
  std::optional<LabeledScan> convert(const mrpt::obs::CObservation& observation);

  /** From now on, scans come with the pictures that their labels were taken from. */
  void keepPictures(bool keep) { m_keepPictures = keep; }
  const ScanConverterOptions& options() const { return m_options; }

 private:
  void addRangeScan(const mrpt::obs::CObservation3DRangeScan& observation, LabeledScan& scan);
  void addLabels(const mrpt::obs::CObservation3DRangeScan& observation, const PointGrid& grid,
                 const std::vector<std::size_t>& pixels, LabelImage labels, LabeledScan& scan);
  void addNamedCloud(NamedCloud named, LabeledScan& scan) const;

  semantic_types::ClassTable m_table;
  ScanConverterOptions m_options;
  std::shared_ptr<ImageLabeler> m_labeler;
  /** The rays of the camera met last. */
  std::unique_ptr<PixelRays> m_rays;
  bool m_keepPictures = false;
};

}  // namespace labeled_cloud
