#include <labeled_cloud/LabelImage.h>

#include <cmath>

namespace labeled_cloud {

const strict_files::Choices<LabelImage::View>& choicesOf(LabelImage::View) {
  using View = LabelImage::View;
  static const strict_files::Choices<View> choices = {{"depth", View::Depth},
                                                      {"color", View::Color}};
  return choices;
}

using semantic_types::ClassId;
using semantic_types::kNoClass;

std::optional<std::size_t> LabelImage::cellAt(double u, double v) const {
  const double col = std::floor((u + 0.5) * cells.scaleX);
  const double row = std::floor((v + 0.5) * cells.scaleY - cells.shiftY);
  if (!(col >= 0 && col < cols && row >= 0 && row < rows)) return std::nullopt;
  return static_cast<std::size_t>(row) * cols + static_cast<std::size_t>(col);
}

ClassId LabelImage::classOf(std::size_t cell) const {
  if (probabilities.empty()) return classes[cell];
  const std::size_t plane = std::size_t(rows) * cols, planes = probabilities.size() / plane;
  ClassId best = kNoClass;
  float most = 0;
  for (std::size_t k = 0; k < planes; ++k) {
    const float p = probabilities[k * plane + cell];
    if (p > most) most = p, best = static_cast<ClassId>(k + 1);
  }
  return best;
}

}  // namespace labeled_cloud
