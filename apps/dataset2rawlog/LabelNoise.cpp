#include "LabelNoise.h"

#include <cmath>
#include <stdexcept>

namespace dataset2rawlog {

LabelNoise::LabelNoise(double share, std::uint64_t seed, int classes)
    : m_share(share), m_classes(classes), m_random(seed) {
  if (!(share >= 0 && share <= 1))
    throw std::invalid_argument("--label-noise " + std::to_string(share) + ": must be 0 to 1");
  if (share > 0 && classes < 2)
    throw std::invalid_argument("--label-noise needs a class table of two classes or more");
}

void LabelNoise::apply(std::vector<semantic_types::ClassId>& labels) {
  if (m_share == 0) return;
  // The standard library's distributions differ between its implementations; its engines do not.
  const auto uniform = [this] { return std::ldexp(static_cast<double>(m_random() >> 11), -53); };
  for (auto& label : labels) {
    if (label == semantic_types::kNoClass || uniform() >= m_share) continue;
    const auto other = 1 + static_cast<std::uint32_t>(uniform() * (m_classes - 1));
    label = static_cast<semantic_types::ClassId>(other < label ? other : other + 1);
  }
}

}  // namespace dataset2rawlog
