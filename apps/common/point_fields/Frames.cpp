#include "Frames.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace point_fields {

using Eigen::Isometry3d;

namespace {

constexpr Stamp kKept = 30'000'000'000;  // ns
constexpr std::size_t kMostFrames = 1000, kMostPoses = 30'000;

std::string withoutSlash(const std::string& name) {
  return name.rfind('/', 0) == 0 ? name.substr(1) : name;
}

}  // namespace

std::string Frames::add(const FramePose& pose, Kind kind) {
  const std::string parent = withoutSlash(pose.parent), child = withoutSlash(pose.child);
  const std::string which = "the transform from '" + parent + "' to '" + child + "'";
  constexpr double kOff = 0.1;
  if (!pose.translation.allFinite() || !(std::abs(pose.rotation.norm() - 1) < kOff))
    return which + " is no pose";
  if (child.empty() || parent.empty() || child == parent) return which + " has no two frames";
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (m_isLive && m_frames.size() >= kMostFrames && m_frames.count(child) == 0)
    return which + " is left out: there are " + std::to_string(kMostFrames) + " frames";
  const Chain above = chainOf(parent);
  if (std::find(above.begin(), above.end(), child) != above.end())
    return which + " makes a ring of frames";
  Frame& frame = m_frames[child];
  if (!frame.poses.empty()) {
    if (kind == Kind::Odometers && frame.kind != kind) return {};
    if (!m_isLive && frame.parent != parent) return which + " has another parent";
  }
  std::string problem;
  if (frame.parent != parent || frame.kind != kind || kind == Kind::Static) frame.poses.clear();
  if (m_isLive && !frame.poses.empty() && pose.stamp < frame.poses.rbegin()->first - kKept) {
    problem = "stamps of " + which + " went back; what was before is forgotten";
    frame.poses.clear();
  }
  frame.parent = parent;
  frame.kind = kind;
  frame.poses[pose.stamp] = {pose.translation, pose.rotation.normalized()};
  if (m_isLive) forgetOld(frame);
  return problem;
}

void Frames::forgetOld(Frame& frame) const {
  auto& poses = frame.poses;
  while (poses.size() > kMostPoses || poses.begin()->first < poses.rbegin()->first - kKept)
    poses.erase(poses.begin());
}

Frames::Chain Frames::chainOf(std::string frame) const {
  Chain chain = {withoutSlash(frame)};
  for (auto it = m_frames.find(chain[0]); it != m_frames.end(); it = m_frames.find(chain.back()))
    chain.push_back(it->second.parent);
  return chain;
}

/** From both frames to the first that is above both. */
bool Frames::parts(const std::string& target, const std::string& source, Chain& up,
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

std::optional<Isometry3d> Frames::Frame::at(Stamp stamp) const {
  if (kind == Kind::Static) return poses.begin()->second.isometry();
  const auto after = poses.lower_bound(stamp);
  if (after == poses.end()) return std::nullopt;
  const auto& [end, b] = *after;
  if (end == stamp) return b.isometry();
  if (after == poses.begin()) return std::nullopt;
  const auto& [begin, a] = *std::prev(after);
  const double share = static_cast<double>(stamp - begin) / static_cast<double>(end - begin);
  return Pose{a.translation + share * (b.translation - a.translation),
              a.rotation.slerp(share, b.rotation)}
      .isometry();
}

Frames::Answer Frames::find(const std::string& target, const std::string& source,
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
      const auto T_parent_frame = frame.at(stamp);
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

std::optional<Stamp> Frames::latest(const std::string& target, const std::string& source) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  Chain up, down;
  if (!parts(target, source, up, down)) return std::nullopt;
  std::optional<Stamp> latest;
  up.insert(up.end(), down.begin(), down.end());
  for (const std::string& name : up)
    if (const Frame& frame = m_frames.at(name); frame.kind != Kind::Static)
      latest = std::min(latest.value_or(frame.poses.rbegin()->first), frame.poses.rbegin()->first);
  return latest;
}

std::string Frames::robotOf(const std::string& sensor) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  for (const std::string& name : chainOf(sensor))
    if (const auto it = m_frames.find(name);
        it != m_frames.end() && it->second.kind != Kind::Static)
      return name;
  return {};
}

std::string Frames::rootOf(const std::string& frame) const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return chainOf(frame).back();
}

}  // namespace point_fields
