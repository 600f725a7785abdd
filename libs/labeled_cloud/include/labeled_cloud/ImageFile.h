#pragma once
#include <filesystem>

namespace cv {
class Mat;
}

namespace labeled_cloud {

/** Which kinds of image files are read. */
enum class ImageKinds {
  Lossless,  ///< PNG, TIFF, BMP and PNM: values of pixels that mean something
  All        ///< JPEG, too
};

/** The pixels of an image file as they are stored, its kind told by its first bytes. (OpenCV tries
 * its decoders in turn: it takes some files of one kind for another, and ends the process over
 * damaged ones.) Colors are BGR(A).
 * \throw std::runtime_error naming the file: there is none, it is no image, it is damaged, or it
 * announces more pixels than its bytes can hold. */
cv::Mat readImageFile(const std::filesystem::path& file, ImageKinds kinds);

/** What readImageFile() looks at before it reads the pixels, for those who have others read them.
 * \throw std::runtime_error as above. */
void checkImageFile(const std::filesystem::path& file, ImageKinds kinds);

}  // namespace labeled_cloud
