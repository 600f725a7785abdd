#pragma once
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/LabeledScan.h>
#include <labeled_cloud/PointSource.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semantic_types/ClassTable.h>

#include <memory>
#include <optional>

namespace labeled_cloud {

class PixelRays;
struct PointGrid;

struct ScanConverterOptions {
  /** Depth images: one point for each block of this many pixels squared, the block's nearest; it
   * keeps the label of its own pixel. */
  int decimation = 1;
  /** Depth images: leave out pixels between a surface in front and one behind that lie on neither,
   * farther from both than this share of their depth. 0: keep all. */
  double flyingPixelThreshold = 0;
  /** Depth images with labels in a color image of another camera: how many pixels a point in front
   * must shift against one behind it, between the two views, to hide it. 0: nothing is hidden. */
  double occlusionParallax = 1.5;
  /** What the labels say. */
  LabelModel labels;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** Makes labeled clouds of observations.
 *
 * - CObservation3DRangeScan: the range image, or the 3D points where there is none, each point with
 *   the label of its pixel in the image that the labels belong to. In a color image of another
 *   camera that is the pixel it is projected to; points outside of it or hidden have no class.
 *   Labels come from the ImageLabeler given, else from the observation's pixelLabels, which are
 *   those of the depth image.
 * - CObservationLabeledCloud: as it is. Where it names its classes, they are found by name in the
 *   class table; otherwise its class ids are those of the table.
 * - CObservationPointCloud, CObservationVelodyneScan, CObservation2DRangeScan: points without a
 *   class, which count for occupancy only.
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
   * \throw std::runtime_error why an observation of these classes cannot be used: no range data, no
   * calibration, labels of another size than their image, an unknown class, an external file
   * that is missing. */
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
