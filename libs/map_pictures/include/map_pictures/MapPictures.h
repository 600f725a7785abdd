#pragma once
#include <semantic_octree/SemanticOcTree.h>
#include <strict_files/OptionList.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace map_pictures {

/** What all pictures of a map have in common. */
struct PictureStyle {
  /** Size of the map's part of the picture, pixels; the legend stands to its right. */
  int width = 1600, height = 1200;
  /** Cells with their center above are not drawn, m. Without: nothing is cut off, except the
   * ceiling of a map that lies under one (an indoor map). */
  std::optional<double> maxHeight;

  // For programs, without a name in files.
  /** Cells with their center more than that above the ground are not drawn, m: above the lowest
   * occupied cell within about 1.5 m to 3 m. On hills one height would be too high here and too low
   * there. Without: nothing is cut off so. */
  std::optional<double> maxAboveGround;
  bool legend = true;  ///< names and colors of the classes that the picture shows
  std::string title;   ///< written above the legend

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** The map from above, +x to the right and +y up, with a scale bar and the axes. Each column has
 * its highest occupied cell in the color of its likeliest class (gray: none), shaded by the relief.
 * (What draws more on a map begins with a MapCanvas.)
 * \return BGR, 8 bits. An empty map gives an empty sheet.
 * \throw std::invalid_argument as PictureStyle::validate(). */
cv::Mat renderTopView(const semantic_octree::SemanticOcTree& tree, const PictureStyle& style = {});

/** Where a perspective view is taken from. */
struct Viewpoint {
  /** Direction in which the camera looks, degrees from +x towards +y. */
  double heading = 60;
  /** How far it looks down, degrees, (0, 90]. */
  double tilt = 35;

  void describe(strict_files::OptionList& list);
  /** \throw std::invalid_argument naming the field and its value. */
  void validate() const;
};

/** The map in perspective, rendered without a display.
 * \return BGR, 8 bits. An empty map gives an empty sheet.
 * \throw std::invalid_argument bad style or viewpoint
 * \throw std::runtime_error no OpenGL context can be made, not even in software. */
cv::Mat renderPerspective(const semantic_octree::SemanticOcTree& tree,
                          const PictureStyle& style = {}, const Viewpoint& viewpoint = {});

/** Writes a PNG. The file is complete or untouched. \throw std::runtime_error naming the file. */
void savePicture(const cv::Mat& picture, const std::filesystem::path& file);

/** A picture of the map from above that geographic software places by itself: north (up) is +y. */
struct ClassMap {
  cv::Mat picture;        ///< BGR, 8 bits
  std::string worldFile;  ///< the six lines of a .pgw
};

/** The map is at the left, the legend at the right. A column of voxels has whole pixels, in the
 * exact color of its highest occupied leaf's likeliest class.
 * \param maxHeight leaves with their center above are not drawn, m; without: nothing is cut off,
 * except the ceiling of a map that lies under one
 * \param columnsAtOnce columns of voxels that are looked at together, some 30 bytes each; a row
 * at least. Of a map in a folder, each of these bands brings in its tiles
 * \throw std::runtime_error nothing is occupied, or the map is too wide for a picture. */
ClassMap drawClassMap(const semantic_octree::SemanticOcTree& tree,
                      const std::optional<double>& maxHeight = {}, int columnsAtOnce = 3000000);

}  // namespace map_pictures
