#include "Transforms.h"

#include <algorithm>
#include <cmath>

namespace semantic_map_ros2 {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr Stamp kKept = 30'000'000'000;  // ns
constexpr std::size_t kMostFrames = 1000, kMostPoses = 30'000;

/** Frames of ROS 1 begin with a slash. */
std::string nameOf(const char* frame) {
  const std::string name = ros2::textOf(frame);
  return name.rfind('/', 0) == 0 ? name.substr(1) : name;
}

Isometry3d isometry(const Vector3d& translation, const Quaterniond& rotation) {
  Isometry3d T = Isometry3d::Identity();
  T.translation() = translation;
  T.linear() = rotation.toRotationMatrix();
  return T;
}

}  // namespace

Isometry3d isometryOf(const geometry_msgs_msg_dds__Pose_& pose) {
  const auto& [p, q] = pose;
  return isometry({p.x, p.y, p.z}, Quaterniond(q.w, q.x, q.y, q.z).normalized());
}

geometry_msgs_msg_dds__Pose_ poseOf(const Isometry3d& T) {
  const Quaterniond q(T.linear());
  const auto& t = T.translation();
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

geometry_msgs_msg_dds__Transform_ transformOf(const Isometry3d& T) {
  const auto [p, q] = poseOf(T);
  return {{p.x, p.y, p.z}, q};
}

std::string Transforms::add(const ros2::TransformStamped& message, bool isStatic) {
  const auto& [t, r] = message.transform;
  return take(message.header, message.child_frame_id, {{t.x, t.y, t.z}, {r.w, r.x, r.y, r.z}},
              isStatic, false);
}

std::string Transforms::add(const ros2::Odometry& message) {
  const auto& [t, r] = message.pose.pose;
  return take(message.header, message.child_frame_id, {{t.x, t.y, t.z}, {r.w, r.x, r.y, r.z}},
              false, true);
}

std::string Transforms::take(const ros2::Header& header, const char* childFrame, const Pose& pose,
                             bool isStatic, bool isOdometers) {
  const std::string parent = nameOf(header.frame_id), child = nameOf(childFrame);
  const std::string which = "the transform from '" + parent + "' to '" + child + "'";
  constexpr double kOff = 0.1;
  if (!pose.translation.allFinite() || !(std::abs(pose.rotation.norm() - 1) < kOff))
    return which + " is no pose";
  if (child.empty() || parent.empty() || child == parent) return which + " has no two frames";
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (m_frames.size() >= kMostFrames && m_frames.count(child) == 0)
    return which + " is left out: there are " + std::to_string(kMostFrames) + " frames";
  const Chain above = chainOf(parent);
  if (std::find(above.begin(), above.end(), child) != above.end())
    return which + " makes a ring of frames";
  Frame& frame = m_frames[child];
  if (isOdometers && !frame.isOdometers && !frame.poses.empty()) return {};
  std::string problem;
  const Stamp stamp = ros2::stampOf(header.stamp);
  if (frame.parent != parent || frame.isOdometers != isOdometers || isStatic) frame.poses.clear();
  if (!frame.poses.empty() && stamp < frame.poses.rbegin()->first - kKept) {
    problem = "stamps of " + which + " went back; what was before is forgotten";
    frame.poses.clear();
  }
  frame.parent = parent;
  frame.isStatic = isStatic;
  frame.isOdometers = isOdometers;
  frame.poses[stamp] = {pose.translation, pose.rotation.normalized()};
  while (frame.poses.size() > kMostPoses ||
         frame.poses.begin()->first < frame.poses.rbegin()->first - kKept)
    frame.poses.erase(frame.poses.begin());
  return problem;
}

Transforms::Chain Transforms::chainOf(std::string frame) const {
  Chain chain = {frame};
  for (auto it = m_frames.find(frame); it != m_frames.end(); it = m_frames.find(chain.back()))
    chain.push_back(it->second.parent);
  return chain;
}

/** From both frames to the first that is above both. */
bool Transforms::parts(const std::string& target, const std::string& source, Chain& up,
                       Chain& down) const {
  up = chainOf(source), down = chainOf(target);
  for (std::size_t i = 0; i < up.size(); ++i)
    if (const auto at = std::find(down.begin(), down.end(), up[i]); at != down.end()) {
      up.resize(i);
      down.erase(at, down.end());
      return true;
    }
  return false;
}

std::optional<Isometry3d> Transforms::at(const Frame& frame, Stamp stamp) {
  const auto& poses = frame.poses;
  if (frame.isStatic)
    return isometry(poses.begin()->second.translation, poses.begin()->second.rotation);
  const auto after = poses.lower_bound(stamp);
  if (after == poses.end()) return std::nullopt;
  const auto& [end, b] = *after;
  if (end == stamp) return isometry(b.translation, b.rotation);
  if (after == poses.begin()) return std::nullopt;
  const auto& [begin, a] = *std::prev(after);
  const double share = static_cast<double>(stamp - begin) / static_cast<double>(end - begin);
  return isometry(a.translation + share * (b.translation - a.translation),
                  a.rotation.slerp(share, b.rotation));
}

Transforms::Answer Transforms::find(const std::string& target, const std::string& source,
                                    Stamp stamp) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  Chain up, down;
  if (!parts(target, source, up, down))
    return {{}, "no transform connects '" + target + "' and '" + source + "'", false};
  Isometry3d T = Isometry3d::Identity();
  const auto climb = [&](const Chain& chain, Answer& answer) {
    T.setIdentity();
    for (const std::string& name : chain) {
      const Frame& frame = m_frames.at(name);
      const auto T_parent_frame = at(frame, stamp);
      if (!T_parent_frame) {
        answer.isLost = stamp < frame.poses.begin()->first;
        answer.problem = "the transform from '" + frame.parent + "' to '" + name + "' " +
                         (answer.isLost ? "begins later" : "did not come in time");
        return false;
      }
      T = *T_parent_frame * T;
    }
    return true;
  };
  Answer answer;
  if (!climb(down, answer)) return answer;
  const Isometry3d T_common_target = T;
  if (!climb(up, answer)) return answer;
  answer.T_target_source = down.empty() ? T : T_common_target.inverse() * T;
  return answer;
}

std::optional<Stamp> Transforms::latest(const std::string& target,
                                        const std::string& source) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  Chain up, down;
  if (!parts(target, source, up, down)) return std::nullopt;
  std::optional<Stamp> latest;
  up.insert(up.end(), down.begin(), down.end());
  for (const std::string& name : up)
    if (const Frame& frame = m_frames.at(name); !frame.isStatic)
      latest = std::min(latest.value_or(frame.poses.rbegin()->first), frame.poses.rbegin()->first);
  return latest;
}

}  // namespace semantic_map_ros2
