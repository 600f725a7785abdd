#pragma once
#include <filesystem>
#include <vector>

#include "DrivePicture.h"

namespace semantic_map_drive {

/** Takes pictures along the way. */
class Animation : public DriveObserver {
 public:
  /** \param folder of the frames, created \param period s of the drive between frames */
  Animation(DrivePicture picture, std::filesystem::path folder, double period);

  void onSensed(const DriveLoop& loop, const std::vector<Observation>& seen) override;
  void onFinished(const DriveLoop& loop) override;

  /** The frames so far, in order. */
  std::vector<std::filesystem::path> frames() const;
  const cv::Mat& last() const { return m_last; }
  /** Makes a GIF of the frames, with ImageMagick. \return false if that is not installed, or fails
   */
  bool writeGif(const std::filesystem::path& file) const;

 private:
  void shoot(const DriveLoop& loop);
  std::filesystem::path frame(int number) const;

  DrivePicture m_picture;
  std::filesystem::path m_folder;
  double m_period, m_next = 0;
  int m_frames = 0;
  cv::Mat m_last;
};

}  // namespace semantic_map_drive
