#include "SmallOnnx.h"

#include <fstream>

// Field numbers are those of onnx.proto; the encoding is that of Protocol Buffers.
namespace {

std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 128; value >>= 7) bytes += static_cast<char>(value | 128);
  return bytes + static_cast<char>(value);
}

std::string field(int number, std::int64_t value) {
  return varint(std::uint64_t(number) << 3) + varint(static_cast<std::uint64_t>(value));
}

std::string field(int number, const std::string& bytes) {
  return varint(std::uint64_t(number) << 3 | 2) + varint(bytes.size()) + bytes;
}

std::string valueInfo(const std::string& name, const SmallOnnx::Shape& shape) {
  std::string dims;
  for (const auto size : shape) dims += field(1, field(1, size));
  const std::string tensor = field(1, 1) + field(2, dims);
  return field(1, name) + field(2, field(1, tensor));
}

std::string encode(const SmallOnnx::Attribute& a) {
  constexpr int kInts = 7;
  std::string bytes = field(1, a.name);
  for (const auto value : a.values) bytes += field(8, value);
  return bytes + field(20, kInts);
}

}  // namespace

void SmallOnnx::constant(const std::string& name, const Shape& shape,
                         const std::vector<float>& values) {
  std::string tensor;
  for (const auto size : shape) tensor += field(1, size);
  tensor += field(2, 1) + field(8, name);
  const std::string raw(reinterpret_cast<const char*>(values.data()),
                        values.size() * sizeof(float));
  m_graph += field(5, tensor + field(9, raw));
}

void SmallOnnx::node(const std::string& op, const std::vector<std::string>& inputs,
                     const std::string& output, const std::vector<Attribute>& attributes) {
  std::string node;
  for (const auto& input : inputs) node += field(1, input);
  node += field(2, output) + field(3, output) + field(4, op);
  for (const Attribute& a : attributes) node += field(5, encode(a));
  m_graph += field(1, node);
}

std::filesystem::path SmallOnnx::save(const std::filesystem::path& file, const Shape& input,
                                      const Shape& output) const {
  const std::string graph = m_graph + field(2, std::string("small")) +
                            field(11, valueInfo("image", input)) +
                            field(12, valueInfo("scores", output));
  constexpr int kIrVersion = 6, kOperators = 11;
  std::ofstream(file, std::ios::binary)
      << field(1, kIrVersion) + field(7, graph) + field(8, field(2, kOperators));
  return file;
}
