#pragma once
#include <semantic_types/ClassTable.h>

#include <filesystem>
#include <string>

#include "SmallOnnx.h"

/** How sure NearestColorNetwork is: score = -kSharpness * squared distance of colors in 0..1. */
constexpr float kSharpness = 20;

/** A network that answers the class of the nearest color: a 1 x 1 convolution, as -|p - c|^2 is 2 p
 * c - |c|^2 but for what all classes share. */
inline std::filesystem::path saveNearestColorNetwork(const std::filesystem::path& file, int rows,
                                                     int cols,
                                                     const semantic_types::ClassTable& table) {
  std::vector<float> weights, biases;
  for (int id = 1; id <= table.size(); ++id) {
    const auto& c = table.color(static_cast<semantic_types::ClassId>(id));
    float square = 0;
    for (const float value : {c.r / 255.f, c.g / 255.f, c.b / 255.f}) {
      weights.push_back(kSharpness * 2 * value);
      square += value * value;
    }
    biases.push_back(-kSharpness * square);
  }
  SmallOnnx net;
  net.constant("w", {table.size(), 3, 1, 1}, weights);
  net.constant("b", {table.size()}, biases);
  net.node("Conv", {"image", "w", "b"}, "scores",
           {{"kernel_shape", {1, 1}}, {"strides", {1, 1}}, {"pads", {0, 0, 0, 0}}});
  return net.save(file, {1, 3, rows, cols}, {1, table.size(), rows, cols});
}

/** The configuration that goes with it. */
inline std::string nearestColorConfig(int rows, int cols, const semantic_types::ClassTable& table) {
  std::string names;
  for (int id = 1; id <= table.size(); ++id)
    names += (id > 1 ? ", " : "") + table.name(static_cast<semantic_types::ClassId>(id));
  return "input: {width: " + std::to_string(cols) + ", height: " + std::to_string(rows) +
         "}\nclasses: [" + names + "]\n";
}
