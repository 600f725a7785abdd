#pragma once
#include <labeled_cloud/NetworkLabeler.h>

#include <opencv2/core.hpp>

namespace labeled_cloud {

/** A network's output for some images. */
class NetworkAnswer {
 public:
  /** Both references must outlive the answer.
   * \throw std::runtime_error naming the network: the output's shape is not what OPTIONS say. */
  NetworkAnswer(const cv::Mat& output, std::size_t images, const NetworkOptions& options,
                const std::filesystem::path& network);

  /** The labels of one of the images: size and labels are set. */
  LabelImage labels(std::size_t image, int numClasses) const;

 private:
  cv::Mat planesOf(std::size_t image) const;
  std::vector<semantic_types::ClassId> classesOfIds(const cv::Mat& ids) const;

  const NetworkOptions& m_options;
  const std::filesystem::path& m_network;
  cv::Mat m_output;
  int m_channels, m_rows, m_cols;
};

}  // namespace labeled_cloud
