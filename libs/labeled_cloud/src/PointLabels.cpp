#include "PointLabels.h"

namespace labeled_cloud {

void PointLabels::take(std::size_t point, const LabelImage& image, std::size_t cell) {
  if (!image.probabilities.empty()) {
    const std::size_t plane = std::size_t(image.rows) * image.cols;
    const std::size_t classes = image.probabilities.size() / plane;
    m_probabilities.resize(m_points * classes);
    for (std::size_t k = 0; k < classes; ++k)
      m_probabilities[point * classes + k] = image.probabilities[k * plane + cell];
    return;
  }
  m_classes.resize(m_points);
  m_classes[point] = image.classes[cell];
  if (image.confidences.empty()) return;
  m_confidences.resize(m_points);
  m_confidences[point] = image.confidences[cell];
}

std::vector<float> PointLabels::moveTo(semantic_types::LabeledCloud& cloud) {
  cloud.classes = std::move(m_classes);
  cloud.probabilities = std::move(m_probabilities);
  return std::move(m_confidences);
}

}  // namespace labeled_cloud
