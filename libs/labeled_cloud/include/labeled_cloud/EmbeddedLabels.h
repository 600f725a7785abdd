#pragma once
#include <labeled_cloud/LabelImage.h>

namespace labeled_cloud {

/** The labels in CObservation3DRangeScan::pixelLabels, which holds at most 64 classes.
 *
 * MRPT does not say which image they belong to: the depth image, unless told otherwise.
 * Label i stands for the class of its name in `pixelLabelNames`; where it has no name, for the raw
 * id i of the class table. A pixel without labels has no class, one with several has the lowest. */
class EmbeddedLabels : public ImageLabeler {
 public:
  explicit EmbeddedLabels(const semantic_types::ClassTable& table,
                          LabelImage::View view = LabelImage::View::Depth)
      : m_table(table), m_view(view) {}

  /** \throw std::runtime_error a label of a pixel is not in the class table (and the table takes
   * that for an error). */
  std::optional<LabelImage> label(const mrpt::obs::CObservation& observation) override;

 private:
  semantic_types::ClassTable m_table;
  LabelImage::View m_view;
};

}  // namespace labeled_cloud
