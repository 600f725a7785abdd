#include <labeled_cloud/NetworkLabeler.h>

#include <labeled_cloud/Pictures.h>
#include <mrpt_compat/Images.h>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace labeled_cloud {

using mrpt::obs::CObservation;
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

/** Leaves pixels without a class where one that is not in the table is likelier than all of its
 * classes together. */
void dropOthers(cv::Mat1f& planes) {
  cv::Mat1f sum;
  cv::reduce(planes, sum, 0, cv::REDUCE_SUM);
  for (int i = 0; i < planes.cols; ++i)
    if (sum(i) <= 0.9999f) planes.col(i) *= sum(i) >= 0.5f ? 1 / sum(i) : 0.f;
}

}  // namespace

struct NetworkLabeler::Network {
  std::filesystem::path file;
  int numClasses;
  NetworkOptions options;
  cv::dnn::Net net;

  /** The output for one image. */
  cv::Mat run(const cv::Mat& input) try {
    net.setInput(cv::dnn::blobFromImage(input));
    return options.output.empty() ? net.forward() : net.forward(options.output);
  } catch (const cv::Exception& e) {
    throw std::runtime_error(file.string() + ": the network cannot be run: " + e.err);
  }
  /** \throw std::runtime_error naming the network: the output is not what the options say. */
  LabelImage labelsOf(const cv::Mat& output) const;
  std::vector<ClassId> classesOfIds(const cv::Mat1f& ids) const;
};

LabelImage NetworkLabeler::Network::labelsOf(const cv::Mat& output) const {
  const bool ids = options.content == NetworkOptions::Content::Ids;
  const bool flat = ids && output.dims == 3;
  const int channels = flat ? 1 : output.dims == 4 ? output.size[1] : 0;
  if (channels == 0 || output.size[0] != 1)
    throw std::runtime_error(file.string() + ": the network answers " + shapeOf(output) +
                             ", expected 1 x classes x rows x columns");
  const int expected = ids ? 1 : int(options.classes.size());
  if (channels != expected)
    throw std::runtime_error(file.string() + ": the network answers " + std::to_string(channels) +
                             " channels, but its configuration names " + std::to_string(expected) +
                             (ids ? " of ids" : " classes"));
  LabelImage labels;
  labels.rows = output.size[flat ? 1 : 2], labels.cols = output.size[flat ? 2 : 3];
  cv::Mat planes;
  output.reshape(1, {channels, labels.rows * labels.cols}).convertTo(planes, CV_32F);
  if (ids) {
    labels.classes = classesOfIds(planes);
    return labels;
  }
  if (options.content == NetworkOptions::Content::Scores) softmax(planes);
  cv::Mat1f classes = folded(planes, options.classes, numClasses);
  dropOthers(classes);
  labels.probabilities.assign(classes.begin(), classes.end());
  return labels;
}

std::vector<ClassId> NetworkLabeler::Network::classesOfIds(const cv::Mat1f& ids) const {
  std::vector<ClassId> classes;
  for (const float id : ids) {
    if (!(id >= 0 && id < float(options.classes.size())))
      throw std::runtime_error(file.string() + ": the network answers class " + std::to_string(id) +
                               " of " + std::to_string(options.classes.size()));
    classes.push_back(options.classes[std::size_t(id)]);
  }
  return classes;
}

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
  image.convertTo(image, CV_32FC3, 1 / 255.0);
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

std::optional<LabelImage> NetworkLabeler::label(const CObservation& observation) {
  const NetworkOptions& options = m_network->options;
  LabelImage::Cells cells;
  LabelImage image = m_network->labelsOf(
      m_network->run(normalized(fit(readBgr(observation), options, cells), options)));
  image.origin = m_network->file.string() + " on '" + observation.sensorLabel + "'";
  image.view = LabelImage::View::Color;
  rescale(cells, image, options);
  image.cells = cells;
  return image;
}

}  // namespace labeled_cloud
