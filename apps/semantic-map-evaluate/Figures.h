#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "Evaluation.h"

namespace semantic_map_evaluate {

struct NamedEvaluation {
  std::string name;
  Evaluation evaluation;
};

/** Reliability diagram: the share of points that is right over the probability that the maps state,
 * above the shares of the points. \throw std::runtime_error gnuplot is missing, or fails. */
void drawReliability(const std::vector<NamedEvaluation>& maps, const std::filesystem::path& file);

}  // namespace semantic_map_evaluate
