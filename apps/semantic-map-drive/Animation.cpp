#include "Animation.h"

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace semantic_map_drive {

Animation::Animation(DrivePicture picture, std::filesystem::path folder, double period)
    : m_picture(std::move(picture)), m_folder(std::move(folder)), m_period(period) {
  std::filesystem::create_directories(m_folder);
}

void Animation::onSensed(const DriveLoop& loop, const std::vector<Observation>&) {
  if (loop.time() < m_next - 1e-6) return;
  m_next += m_period;
  shoot(loop);
}

void Animation::onFinished(const DriveLoop& loop) { shoot(loop); }

void Animation::shoot(const DriveLoop& loop) {
  m_last = m_picture.draw(loop);
  const std::filesystem::path file = frame(m_frames++);
  if (!cv::imwrite(file.string(), m_last))
    throw std::runtime_error(file.string() + ": cannot be written");
}

std::filesystem::path Animation::frame(int number) const {
  char name[32];
  std::snprintf(name, sizeof name, "frame-%04d.png", number);
  return m_folder / name;
}

std::vector<std::filesystem::path> Animation::frames() const {
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < m_frames; ++i) files.push_back(frame(i));
  return files;
}

bool Animation::writeGif(const std::filesystem::path& file) const {
  const auto quoted = [](const std::string& text) {
    std::string safe = "'";
    for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return safe + "'";
  };
  const std::string command = "convert -delay 12 -loop 0 " +
                              quoted((m_folder / "frame-*.png").string()) +
                              " -layers OptimizeTransparency -colors 64 " +
                              quoted("gif:" + file.string()) + " >/dev/null 2>&1";
  return std::system(command.c_str()) == 0;
}

}  // namespace semantic_map_drive
