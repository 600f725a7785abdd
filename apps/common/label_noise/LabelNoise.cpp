#include "LabelNoise.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "Application.h"

namespace label_noise {

using semantic_types::ClassId;
using semantic_types::kNoClass;
namespace {

/** The standard library's distributions differ between its implementations; this does not. */
double uniform(std::uint64_t bits) { return std::ldexp(static_cast<double>(bits >> 11), -53); }

/** The step of splitmix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators").
 */
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return x ^ x >> 31;
}

constexpr double kSmallest = 1.5, kLargest = 4;  // m
/** A class's share of wrong labels, as a multiple of that of all. */
constexpr double kLeast = 0.25, kMost = 1.75;

}  // namespace

LabelNoise::LabelNoise(double share, Kind kind, std::uint64_t seed, int classes)
    : m_share(share),
      m_kind(kind),
      m_seed(seed),
      m_classes(classes),
      m_random(seed),
      m_fixed(drawCubes()) {
  m_random.seed(seed);
  if (!(share >= 0 && share <= (kind == Kind::Points ? 1 : 1 / kMost)))
    throw std::invalid_argument("--label-noise " + std::to_string(share) + ": must be 0 to " +
                                (kind == Kind::Points ? "1" : "0.57 for blobs"));
  if (share > 0 && classes < 2)
    throw std::invalid_argument("--label-noise needs a class table of two classes or more");
}

auto LabelNoise::drawCubes() -> Cubes {
  const std::uint64_t seed = m_random();
  return {seed, kSmallest + (kLargest - kSmallest) * uniform(m_random())};
}

void LabelNoise::apply(semantic_types::LabeledCloud& cloud, const Eigen::Isometry3d& T_map_sensor) {
  if (m_share == 0) return;
  if (m_kind == Kind::Points) return apply(cloud.classes);
  const Cubes fresh = drawCubes();
  const double fixedShare = m_kind == Kind::Persistent ? m_share / 2 : 0;
  const double freshShare = (m_share - fixedShare) / (1 - fixedShare);
  for (std::size_t i = 0; i < cloud.classes.size(); ++i) {
    const ClassId truth = cloud.classes[i];
    if (truth == kNoClass) continue;
    const Eigen::Vector3d point = T_map_sensor * cloud.points[i].cast<double>();
    ClassId& label = cloud.classes[i] = inCube(truth, point, m_fixed, fixedShare);
    if (label == truth) label = inCube(truth, point, fresh, freshShare);
  }
}

ClassId LabelNoise::inCube(ClassId id, const Eigen::Vector3d& point, const Cubes& cubes,
                           double share) const {
  std::uint64_t bits = mixed(cubes.seed ^ id);
  for (const double x : {point.x(), point.y(), point.z()})
    bits = mixed(bits ^ static_cast<std::uint64_t>(std::llround(x / cubes.edge)));
  const double rate = kLeast + (kMost - kLeast) * uniform(mixed(m_seed ^ id));
  return uniform(bits) < share * rate ? mistakenFor(id, uniform(mixed(bits))) : id;
}

ClassId LabelNoise::mistakenFor(ClassId id, double u) const {
  const std::uint64_t which = u < 1 / 2.0 ? 1 : u < 5 / 6.0 ? 2 : 3;
  const auto other =
      1 + static_cast<std::uint32_t>(uniform(mixed(mixed(m_seed ^ id) + which)) * (m_classes - 1));
  return static_cast<ClassId>(other < id ? other : other + 1);
}

void LabelNoise::apply(std::vector<ClassId>& labels) {
  if (m_share == 0) return;
  if (m_kind != Kind::Points)
    throw std::invalid_argument("--label-noise-kind: label images have points only");
  for (ClassId& label : labels) {
    if (label == kNoClass || uniform(m_random()) >= m_share) continue;
    const auto other = 1 + static_cast<std::uint32_t>(uniform(m_random()) * (m_classes - 1));
    label = static_cast<ClassId>(other < label ? other : other + 1);
  }
}

void addLabelNoiseKind(CLI::App& app, LabelNoise::Kind& kind) {
  using Kind = LabelNoise::Kind;
  addChoice(
      app.add_option("--label-noise-kind", kind,
                     "Points: one by one. Blobs: patches of 1.5 to 4 m, as networks err. "
                     "Persistent: half of these are wrong in all scans"),
      std::map<std::string, Kind>{
          {"points", Kind::Points}, {"blobs", Kind::Blobs}, {"persistent", Kind::Persistent}});
}

}  // namespace label_noise
