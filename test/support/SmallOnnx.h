#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/** Writes small ONNX networks, float32, NCHW, one input "image" and one output "scores". */
class SmallOnnx {
 public:
  using Shape = std::vector<std::int64_t>;

  /** A list of numbers that belongs to a node. */
  struct Attribute {
    std::string name;
    Shape values;
  };

  void constant(const std::string& name, const Shape& shape, const std::vector<float>& values);
  void node(const std::string& op, const std::vector<std::string>& inputs,
            const std::string& output, const std::vector<Attribute>& attributes = {});
  std::filesystem::path save(const std::filesystem::path& file, const Shape& input,
                             const Shape& output) const;

 private:
  std::string m_graph;
};
