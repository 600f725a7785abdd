#pragma once
#include <labeled_cloud/ScanConverter.h>
#include <semantic_types/ClassTable.h>

#include <opencv2/core.hpp>

namespace label_overlay {

/** The color of a class, BGR. */
cv::Vec3b pixelOf(semantic_types::ClassId id, const semantic_types::ClassTable& classes);

/** The photograph, or black where there is none. */
cv::Mat3b photograph(const labeled_cloud::LabeledPicture& picture);

/** A photograph with the colors of its labels' classes half upon it. */
cv::Mat3b withLabels(cv::Mat3b image, const labeled_cloud::LabeledPicture& picture,
                     const semantic_types::ClassTable& classes);

/** The photograph so, or black where there is none. */
mrpt::img::CImage labeledImage(const labeled_cloud::LabeledPicture& picture,
                               const semantic_types::ClassTable& classes);

}  // namespace label_overlay
