#pragma once
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace labeled_cloud {

/** Pixels of a PNG file as they are stored: indices of a palette, gray values of 1 to 16 bits
 * (CV_8UC1, CV_16UC1; OpenCV would stretch the narrow ones and lose the indices), or BGR(A) colors.
 * \param file Its size was checked (checkImageFile()).
 * \throw std::runtime_error it is damaged, or has pixels of another kind. */
cv::Mat readPng(const std::filesystem::path& file);

}  // namespace labeled_cloud
