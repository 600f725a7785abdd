#include "ScanStorage.h"

namespace semantic_octree {
namespace {

template <typename T>
void appendAll(Bytes& bytes, const std::vector<T>& values) {
  appendTo(bytes, values.size());
  const auto* begin = reinterpret_cast<const char*>(values.data());
  bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(T));
}

template <typename T>
void takeAll(const char*& bytes, std::vector<T>& values) {
  values.resize(takeFrom<std::size_t>(bytes));
  if (values.empty()) return;
  std::memcpy(static_cast<void*>(values.data()), bytes, values.size() * sizeof(T));
  bytes += values.size() * sizeof(T);
}

}  // namespace

Bytes packCloud(const semantic_types::LabeledCloud& cloud) {
  Bytes bytes;
  bytes.reserve(24 + cloud.points.size() * sizeof(Eigen::Vector3f) + cloud.classes.size() +
                cloud.probabilities.size() * sizeof(float));
  appendAll(bytes, cloud.points);
  appendAll(bytes, cloud.classes);
  appendAll(bytes, cloud.probabilities);
  return bytes;
}

semantic_types::LabeledCloud unpackCloud(const Bytes& bytes) {
  semantic_types::LabeledCloud cloud;
  const char* at = bytes.data();
  takeAll(at, cloud.points);
  takeAll(at, cloud.classes);
  takeAll(at, cloud.probabilities);
  return cloud;
}

}  // namespace semantic_octree
