#include <labeled_cloud/LabelImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <array>
#include <stdexcept>

namespace labeled_cloud {

using mrpt::obs::TPixelLabelInfo;
using mrpt::obs::TPixelLabelInfoBase;
using semantic_types::ClassId;
using semantic_types::ClassTable;
using semantic_types::kNoClass;

namespace {

constexpr int kMaxLabels = 64;

/** Class of each label, looked up when it is met first: labels that no pixel has need no class. */
class ClassOfLabel {
 public:
  ClassOfLabel(const ClassTable& table, const TPixelLabelInfoBase& labels)
      : m_table(table), m_names(labels.pixelLabelNames) {
    m_known.fill(false);
  }

  ClassId operator()(int label) {
    if (!m_known[label]) m_class[label] = lookUp(label), m_known[label] = true;
    return m_class[label];
  }

 private:
  ClassId lookUp(int label) const {
    const auto name = m_names.find(label);
    if (name == m_names.end()) return m_table.fromRaw(label);
    if (const auto id = m_table.find(name->second)) return *id;
    if (m_table.unknownRawId() == ClassTable::UnknownRawId::NoClass) return kNoClass;
    throw std::invalid_argument("label " + std::to_string(label) + " is named '" + name->second +
                                "', which is no class of the table");
  }

  const ClassTable& m_table;
  const TPixelLabelInfoBase::TMapLabelID2Name& m_names;
  std::array<bool, kMaxLabels> m_known;
  std::array<ClassId, kMaxLabels> m_class;
};

/** Fills IMAGE if the bit fields are BYTES wide. */
template <unsigned BYTES>
bool convert(const TPixelLabelInfoBase& labels, ClassOfLabel& classOf, LabelImage& image) {
  const auto* fields = dynamic_cast<const TPixelLabelInfo<BYTES>*>(&labels);
  if (!fields) return false;
  const auto& bits = fields->pixelLabels;
  image.rows = static_cast<int>(bits.rows());
  image.cols = static_cast<int>(bits.cols());
  image.classes.reserve(bits.size());
  for (int row = 0; row < image.rows; ++row)
    for (int col = 0; col < image.cols; ++col) {
      const std::uint64_t set = bits(row, col);
      image.classes.push_back(set ? classOf(__builtin_ctzll(set)) : kNoClass);
    }
  return true;
}

}  // namespace

std::optional<LabelImage> EmbeddedLabels::label(const mrpt::obs::CObservation& observation) {
  const auto* scan = dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation);
  if (!scan || !scan->pixelLabels) return std::nullopt;
  const TPixelLabelInfoBase& labels = *scan->pixelLabels;
  LabelImage image;
  image.view = m_view;
  image.origin = "pixelLabels of '" + scan->sensorLabel + "'";
  ClassOfLabel classOf(m_table, labels);
  try {
    if (!convert<1>(labels, classOf, image) && !convert<2>(labels, classOf, image) &&
        !convert<3>(labels, classOf, image) && !convert<4>(labels, classOf, image) &&
        !convert<8>(labels, classOf, image))
      throw std::invalid_argument(std::to_string(8 * labels.BITFIELD_BYTES) + " labels a pixel");
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(image.origin + ": " + e.what());
  }
  return image;
}

}  // namespace labeled_cloud
