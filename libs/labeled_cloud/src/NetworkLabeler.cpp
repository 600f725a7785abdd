#include <labeled_cloud/NetworkLabeler.h>
#include <labeled_cloud/Pictures.h>
#include <mrpt_compat/Images.h>

#include <algorithm>
#include <numeric>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "NetworkAnswer.h"

namespace labeled_cloud {

using mrpt::obs::CObservation;

struct NetworkLabeler::Network {
  std::filesystem::path file;
  int numClasses;
  NetworkOptions options;
  cv::dnn::Net net;

  /** The output for these inputs: images x channels x rows x columns. */
  cv::Mat run(const std::vector<cv::Mat>& inputs) try {
    const cv::Mat blob = cv::dnn::blobFromImages(inputs);
    net.setInput(blob, options.input);
    return options.output.empty() ? net.forward() : net.forward(options.output);
  } catch (const cv::Exception& e) {
    throw std::runtime_error(file.string() + ": the network cannot be run: " + e.err);
  }
};

NetworkLabeler::NetworkLabeler(const std::filesystem::path& model, int numClasses,
                               const NetworkOptions& options) {
  options.validate();
  if (!std::filesystem::is_regular_file(model))
    throw std::runtime_error(model.string() + ": there is no such network");
  try {
    m_network.reset(
        new Network{model, numClasses, options, cv::dnn::readNetFromONNX(model.string())});
  } catch (const cv::Exception& e) {
    throw std::runtime_error(model.string() + ": OpenCV cannot read this network: " + e.err);
  }
}

NetworkLabeler::~NetworkLabeler() = default;

std::size_t NetworkLabeler::batch() const { return m_network->options.batch; }

std::optional<LabelImage> NetworkLabeler::label(const CObservation& observation) {
  return std::move(label(std::vector<const CObservation*>{&observation}).front());
}

namespace {

/** The observation's image as blue, green, red. */
cv::Mat readBgr(const CObservation& observation) {
  const ColorImage color = colorImageOf(observation);
  if (color.image.isExternallyStored())
    checkImageFile(color.image.getExternalStorageFileAbsolutePath(), ImageKinds::All);
  cv::Mat pixels = mrpt_compat::toOpenCv(color.image);
  color.image.unload();
  if (pixels.channels() == 1) cv::cvtColor(pixels, pixels, cv::COLOR_GRAY2BGR);
  if (pixels.channels() == 4) cv::cvtColor(pixels, pixels, cv::COLOR_BGRA2BGR);
  return pixels;
}

/** Scales an image to the network's input and says where its pixels went. */
cv::Mat fit(const cv::Mat& image, const NetworkOptions& o, LabelImage::Cells& cells) {
  const bool stretch = o.fit == NetworkOptions::Fit::Stretch;
  const double scale = double(o.width) / image.cols;
  const int height = stretch ? o.height : std::max(1, int(std::lround(image.rows * scale)));
  cv::Mat scaled;
  cv::resize(image, scaled, {o.width, height}, 0, 0, cv::INTER_AREA);
  cells = {image.rows, image.cols, scale, double(height) / image.rows, 0};
  if (height > o.height) {
    cells.shiftY = height - o.height;
    scaled = scaled.rowRange(height - o.height, height);
  }
  cv::copyMakeBorder(scaled, scaled, 0, std::max(0, o.height - height), 0, 0, cv::BORDER_REPLICATE);
  return scaled;
}

cv::Mat normalized(cv::Mat image, const NetworkOptions& o) {
  if (o.channels == NetworkOptions::Channels::Rgb) cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  image.convertTo(image, CV_32FC3, o.scale);
  cv::subtract(image, cv::Scalar(o.mean[0], o.mean[1], o.mean[2]), image);
  cv::divide(image, cv::Scalar(o.deviation[0], o.deviation[1], o.deviation[2]), image);
  return image;
}

/** The answer may be coarser than the input, or finer. */
void rescale(LabelImage::Cells& cells, const LabelImage& labels, const NetworkOptions& o) {
  const double x = double(labels.cols) / o.width, y = double(labels.rows) / o.height;
  cells.scaleX *= x, cells.scaleY *= y, cells.shiftY *= y;
}

}  // namespace

std::vector<std::optional<LabelImage>> NetworkLabeler::label(
    const std::vector<const CObservation*>& observations) {
  const NetworkOptions& options = m_network->options;
  std::vector<cv::Mat> inputs;
  std::vector<LabelImage::Cells> cells(observations.size());
  for (std::size_t i = 0; i < observations.size(); ++i)
    inputs.push_back(normalized(fit(readBgr(*observations[i]), options, cells[i]), options));
  const NetworkAnswer answer(m_network->run(inputs), observations.size(), options, m_network->file);
  std::vector<std::optional<LabelImage>> images;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    LabelImage image = answer.labels(i, m_network->numClasses);
    image.origin = m_network->file.string() + " on '" + observations[i]->sensorLabel + "'";
    image.view = LabelImage::View::Color;
    rescale(cells[i], image, options);
    image.cells = cells[i];
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace labeled_cloud
