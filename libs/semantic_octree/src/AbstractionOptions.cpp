#include <semantic_octree/AbstractionOptions.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace semantic_octree {
namespace {

void require(bool ok, const std::string& field, double value, const char* expected) {
  if (!ok)
    throw std::invalid_argument("abstraction: " + field + " = " + std::to_string(value) +
                                ", expected " + expected);
}

bool finiteNotNegative(double x) { return std::isfinite(x) && x >= 0; }

}  // namespace

void Region::validate() const {
  require(finiteNotNegative(weight), "region weight", weight, "a number >= 0");
  require(a.allFinite() && b.allFinite(), "region corner", (a + b).sum(), "finite coordinates");
  if (shape == Shape::Box)
    require((a.array() <= b.array()).all(), "region box edge", (b - a).minCoeff(),
            "the lowest corner first");
  else
    require(std::isfinite(radius) && radius > 0, "region radius", radius, "a positive number");
}

void AbstractionOptions::validate(int numClasses) const {
  weights.validate(numClasses);
  require(finiteNotNegative(unknownWeight) && unknownWeight <= 1, "unknownWeight", unknownWeight,
          "0 to 1");
  require(finiteNotNegative(blockSize), "blockSize", blockSize, "meters, or 0 for no blocks");
  for (const Region& region : regions) region.validate();
  if (prior.empty()) return;
  require(static_cast<int>(prior.size()) == numClasses + 1, "size of prior",
          static_cast<double>(prior.size()), "number of classes + 1");
  for (const double p : prior) require(finiteNotNegative(p), "prior", p, "a probability");
  const double sum = std::accumulate(prior.begin(), prior.end(), 0.0);
  require(std::fabs(sum - 1) < 1e-6, "sum of prior", sum, "1");
}

}  // namespace semantic_octree
