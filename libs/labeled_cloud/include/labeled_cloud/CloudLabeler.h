#pragma once
#include <labeled_cloud/LabelImage.h>
#include <labeled_cloud/LabelModel.h>
#include <labeled_cloud/Pictures.h>
#include <labeled_cloud/ScanConverter.h>
#include <labeled_cloud/Trajectory.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <strict_files/OptionList.h>

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace labeled_cloud {

/** What is known of a camera beside what its observations say, and counts instead of that. */
struct CameraCalibration {
  std::optional<mrpt::img::TCamera> intrinsics;
  /** The optical frame: x right, y down, z forward. */
  std::optional<mrpt::poses::CPose3D> T_robot_camera;
};

/** A calibration as files have it: the optics, or the pose, may be left out as a whole. */
struct CameraDescription {
  std::optional<double> cols, rows, fx, fy, cx, cy;  ///< pixels
  /** The lens's plumb_bob coefficients in MRPT's order, separated by spaces. */
  std::string dist;
  std::optional<double> x, y, z;           ///< of the optical frame in the robot's, m
  std::optional<double> yaw, pitch, roll;  ///< degrees

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming an option that is missing, or what is no coefficient. */
  CameraCalibration calibration() const;
};

struct CloudLabelerOptions {
  /** Largest time between a scan and the picture that labels it, s. */
  double tolerance = 0.06;
  /** By the cameras' sensor labels. */
  std::map<std::string, CameraCalibration> calibrations;
  /** A picture that cannot be used is left out and reported, instead of being an error. */
  bool skipProblems = false;

  /** All but calibrations and skipProblems. */
  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** Gives points of scans without labels the classes of the pixels at which cameras see them, in
 * each camera's picture nearest in time. How the robot moved between picture and scan is taken into
 * account. Where several cameras see a point, the picture nearest in time counts. */
class CloudLabeler {
 public:
  /** The trajectory must outlive the labeler.
   * \throw std::invalid_argument naming the option and its value. */
  CloudLabeler(std::shared_ptr<ImageLabeler> labeler, int numClasses, const LabelModel& model,
               const Trajectory& trajectory, const CloudLabelerOptions& options = {});
  ~CloudLabeler();

  /** Remembers a picture, see isPicture(). Its pixels are not looked at unless a scan needs them.
   */
  void addPicture(mrpt::obs::CObservation::Ptr picture);
  /** Forgets pictures that no scan from this time on can need. */
  void forgetBefore(Trajectory::Time time);
  /** Whether each camera that was met has shown a picture of this time or a later one. */
  bool sawAllCamerasAt(Trajectory::Time time) const;

  /** Labels a scan; without any picture that fits, `labelsMissing` says so.
   * \throw std::runtime_error naming the picture: it cannot be read or labeled, its camera is not
   * calibrated, or its labels are of another size. Not with `skipProblems`. */
  void label(LabeledScan& scan, const mrpt::poses::CPose3D& T_map_robot, bool keepPictures = false);

  /** What was wrong with pictures that were left out since it was asked last. */
  std::vector<std::string> takeProblems() { return std::move(m_problems); }
  const CloudLabelerOptions& options() const { return m_options; }

 private:
  struct Picture;
  using Pictures = std::deque<Picture>;

  std::vector<Picture*> nearestPictures(Trajectory::Time time);
  /** Whether the picture has labels and a calibration that fits them. */
  bool prepare(Picture& picture);
  void load(Picture& picture);
  LabeledPicture seenFrom(const Picture& picture, const LabeledScan& scan,
                          const mrpt::poses::CPose3D& T_map_robot) const;

  std::shared_ptr<ImageLabeler> m_labeler;
  int m_numClasses;
  LabelModel m_model;
  const Trajectory& m_trajectory;
  CloudLabelerOptions m_options;
  std::map<std::string, Pictures> m_pictures;
  std::vector<std::string> m_problems;
};

}  // namespace labeled_cloud
