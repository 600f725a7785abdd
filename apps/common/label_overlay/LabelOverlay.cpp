#include "LabelOverlay.h"

#include <mrpt_compat/Images.h>

#include <opencv2/imgproc.hpp>

namespace label_overlay {

using labeled_cloud::LabeledPicture;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

cv::Vec3b pixelOf(ClassId id, const ClassTable& classes) {
  const auto color = colorOf(id, classes);
  return {color.b, color.g, color.r};
}

cv::Mat3b photograph(const LabeledPicture& picture) {
  cv::Mat image;
  if (!picture.image.isEmpty()) image = mrpt_compat::toOpenCv(picture.image);
  if (image.empty())
    image = cv::Mat3b(picture.labels.pictureRows(), picture.labels.pictureCols(), cv::Vec3b());
  if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  return image;
}

cv::Mat3b withLabels(cv::Mat3b image, const LabeledPicture& picture, const ClassTable& classes) {
  for (int row = 0; row < image.rows; ++row)
    for (int col = 0; col < image.cols; ++col) {
      const auto cell = picture.labels.cellAt(col, row);
      const ClassId id = cell ? picture.labels.classOf(*cell) : kNoClass;
      if (id != kNoClass) image(row, col) = image(row, col) / 2 + pixelOf(id, classes) / 2;
    }
  return image;
}

mrpt::img::CImage labeledImage(const LabeledPicture& picture, const ClassTable& classes) {
  return mrpt_compat::toMrpt(withLabels(photograph(picture), picture, classes));
}

}  // namespace label_overlay
