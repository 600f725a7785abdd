#include "NetworkAnswer.h"

#include <cmath>
#include <stdexcept>

namespace labeled_cloud {

using semantic_types::ClassId;
using semantic_types::kNoClass;

namespace {

std::string shapeOf(const cv::Mat& m) {
  std::string text;
  for (int i = 0; i < m.dims; ++i) text += (i ? " x " : "") + std::to_string(m.size[i]);
  return text;
}

/** Turns each column of scores into probabilities. */
void softmax(cv::Mat planes) {
  cv::Mat1f most, sum;
  cv::reduce(planes, most, 0, cv::REDUCE_MAX);
  for (int k = 0; k < planes.rows; ++k) planes.row(k) -= most;
  cv::exp(planes, planes);
  cv::reduce(planes, sum, 0, cv::REDUCE_SUM);
  for (int k = 0; k < planes.rows; ++k) planes.row(k) /= sum;
}

/** Sums the channels of each class; what the rest of them says is shared out. */
cv::Mat1f folded(const cv::Mat1f& planes, const std::vector<ClassId>& classes, int numClasses) {
  cv::Mat1f result = cv::Mat1f::zeros(numClasses, planes.cols);
  for (int k = 0; k < planes.rows; ++k)
    if (classes[k] != kNoClass) result.row(classes[k] - 1) += planes.row(k);
  return result;
}

/** Leaves pixels without a class where none of the table's reaches its least probability, or where
 * one that is not in the table is likelier than all of them together. */
void dropUnsure(double minConfidence, cv::Mat1f& planes) {
  cv::Mat1f most, sum;
  cv::reduce(planes, most, 0, cv::REDUCE_MAX);
  cv::reduce(planes, sum, 0, cv::REDUCE_SUM);
  for (int i = 0; i < planes.cols; ++i) {
    const bool keep = sum(i) >= 0.5f && most(i) >= minConfidence;
    if (keep && sum(i) > 0.9999f) continue;
    planes.col(i) *= keep ? 1 / sum(i) : 0.f;
  }
}

}  // namespace

NetworkAnswer::NetworkAnswer(const cv::Mat& output, std::size_t images,
                             const NetworkOptions& options, const std::filesystem::path& network)
    : m_options(options), m_network(network) {
  const bool ids = options.content == NetworkOptions::Content::Ids;
  const bool flat = ids && output.dims == 3;
  m_channels = flat ? 1 : output.dims == 4 ? output.size[1] : 0;
  if (m_channels == 0 || output.size[0] != int(images))
    throw std::runtime_error(network.string() + ": the network answers " + shapeOf(output) +
                             ", expected images x classes x rows x columns");
  const int expected = ids ? 1 : int(options.classes.size());
  if (m_channels != expected)
    throw std::runtime_error(network.string() + ": the network answers " +
                             std::to_string(m_channels) +
                             " channels, but its configuration names " + std::to_string(expected) +
                             (ids ? " of ids" : " classes"));
  m_rows = output.size[flat ? 1 : 2];
  m_cols = output.size[flat ? 2 : 3];
  output.convertTo(m_output, CV_32F);
}

cv::Mat NetworkAnswer::planesOf(std::size_t image) const {
  const std::size_t values = std::size_t(m_channels) * m_rows * m_cols;
  return cv::Mat(m_channels, m_rows * m_cols, CV_32F,
                 const_cast<float*>(m_output.ptr<float>()) + image * values)
      .clone();
}

std::vector<ClassId> NetworkAnswer::classesOfIds(const cv::Mat& ids) const {
  std::vector<ClassId> classes;
  for (const float id : cv::Mat1f(ids)) {
    if (!(id >= 0 && id < float(m_options.classes.size())))
      throw std::runtime_error(m_network.string() + ": the network answers class " +
                               std::to_string(id) + " of " +
                               std::to_string(m_options.classes.size()));
    classes.push_back(m_options.classes[std::size_t(id)]);
  }
  return classes;
}

LabelImage NetworkAnswer::labels(std::size_t image, int numClasses) const {
  LabelImage labels;
  labels.rows = m_rows, labels.cols = m_cols;
  const cv::Mat planes = planesOf(image);
  if (m_options.content == NetworkOptions::Content::Ids) {
    labels.classes = classesOfIds(planes);
    return labels;
  }
  if (m_options.content == NetworkOptions::Content::Scores) softmax(planes);
  cv::Mat1f classes = folded(planes, m_options.classes, numClasses);
  dropUnsure(m_options.minConfidence, classes);
  labels.probabilities.assign(classes.begin(), classes.end());
  if (m_options.labels == NetworkOptions::Labels::Argmax) {
    for (int i = 0; i < classes.cols; ++i) labels.classes.push_back(labels.classOf(i));
    labels.probabilities.clear();
  }
  return labels;
}

}  // namespace labeled_cloud
