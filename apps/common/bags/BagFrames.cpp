#include "BagFrames.h"

#include <cmath>

namespace bags {

using Eigen::Isometry3d;

namespace {

/** Old names of frames begin with a slash. */
std::string withoutSlash(const std::string& name) {
  return !name.empty() && name.front() == '/' ? name.substr(1) : name;
}

}  // namespace

void BagFrames::add(const FramePose& pose, bool isStatic) { add(pose, isStatic, false); }
void BagFrames::addOdometry(const FramePose& pose) { add(pose, false, true); }

void BagFrames::add(const FramePose& pose, bool isStatic, bool isOdometers) {
  constexpr double kOff = 0.1;
  if (!pose.translation.allFinite() || !(std::abs(pose.rotation.norm() - 1) < kOff)) return;
  const std::string parent = withoutSlash(pose.parent), child = withoutSlash(pose.child);
  if (parent.empty() || child.empty()) return;
  for (std::string above = parent;; above = m_frames.at(above).parent) {
    if (above == child) return;
    if (m_frames.count(above) == 0) break;
  }
  const auto [it, isNew] = m_frames.try_emplace(child, Frame{parent, isStatic, isOdometers, {}});
  Frame& frame = it->second;
  if (isOdometers != frame.isOdometers || parent != frame.parent) return;
  frame.poses[pose.stamp] =
      Eigen::Translation3d(pose.translation) * Isometry3d(pose.rotation.normalized());
}

std::string BagFrames::robotOf(const std::string& sensor) const {
  std::string frame = withoutSlash(sensor);
  for (auto it = m_frames.find(frame); it != m_frames.end(); it = m_frames.find(frame)) {
    if (!it->second.isStatic) return frame;
    frame = it->second.parent;
  }
  return {};
}

std::optional<Isometry3d> BagFrames::at(const Frame& frame, Stamp stamp) const {
  if (frame.isStatic) return frame.poses.rbegin()->second;
  const auto after = frame.poses.lower_bound(stamp);
  if (after == frame.poses.end()) return std::nullopt;
  if (after->first == stamp) return after->second;
  if (after == frame.poses.begin()) return std::nullopt;
  const auto& [begin, a] = *std::prev(after);
  const auto& [end, b] = *after;
  const double share = static_cast<double>(stamp - begin) / static_cast<double>(end - begin);
  const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
  const Eigen::Vector3d t = a.translation() + share * (b.translation() - a.translation());
  return Eigen::Translation3d(t) * Isometry3d(qa.slerp(share, qb));
}

std::optional<Isometry3d> BagFrames::find(const std::string& name, Stamp stamp,
                                          const std::string& above) const {
  Isometry3d T = Isometry3d::Identity();
  std::string frame = withoutSlash(name);
  for (auto it = m_frames.find(frame); it != m_frames.end() && frame != above;
       it = m_frames.find(frame)) {
    const auto T_parent_frame = at(it->second, stamp);
    if (!T_parent_frame) return std::nullopt;
    T = *T_parent_frame * T;
    frame = it->second.parent;
  }
  return T;
}

}  // namespace bags
