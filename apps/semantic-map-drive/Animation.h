#pragma once
#include <functional>

#include "DrivePicture.h"

namespace semantic_map_drive {

/** Takes pictures along the way, and one at the end. */
class Animation : public DriveObserver {
 public:
  /** \param period s of the drive between pictures \param show gets each of them, BGR */
  Animation(DrivePicture picture, double period, std::function<void(const cv::Mat&)> show)
      : m_picture(std::move(picture)), m_period(period), m_show(std::move(show)) {}

  void onSensed(const DriveLoop& loop, const std::vector<Observation>&) override {
    if (loop.time() < m_next - 1e-6) return;
    m_next += m_period;
    shoot(loop);
  }
  void onFinished(const DriveLoop& loop) override { shoot(loop); }

 private:
  void shoot(const DriveLoop& loop) { m_show(m_picture.frame(loop)); }

  DrivePicture m_picture;
  double m_period, m_next = 0;
  std::function<void(const cv::Mat&)> m_show;
};

}  // namespace semantic_map_drive
