#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/** Writes small ONNX networks, float32, NCHW, one input "image" and one output "scores". */
class SmallOnnx {
 public:
  using Shape = std::vector<std::int64_t>;

  /** An attribute of a node. */
  struct Attribute {
    std::string name;
    std::vector<std::int64_t> ints;  ///< one: an integer
    std::string text;                ///< if not empty: a string
    bool isList = true;
  };

  static Attribute number(const std::string& name, std::int64_t value) {
    return {name, {value}, "", false};
  }
  static Attribute list(const std::string& name, const Shape& values) {
    return {name, values, "", true};
  }
  static Attribute word(const std::string& name, const std::string& text) {
    return {name, {}, text, false};
  }

  void constant(const std::string& name, const Shape& shape, const std::vector<float>& values);
  void node(const std::string& op, const std::vector<std::string>& inputs,
            const std::string& output, const std::vector<Attribute>& attributes = {});
  std::filesystem::path save(const std::filesystem::path& file, const Shape& input,
                             const Shape& output) const;

 private:
  std::string m_graph;
};
