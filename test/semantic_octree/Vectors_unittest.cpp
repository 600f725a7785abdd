// The numbers of vectors.json were computed by an independent script from the filter's formulas.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "FilterStreams.h"

using namespace semantic_octree;

namespace {

nlohmann::json vectors() {
  std::ifstream in(MSO_SOURCE_DIR "/test/semantic_octree/vectors.json");
  return nlohmann::json::parse(in);
}

}  // namespace

TEST(Vectors, likelihoodConsistentIncrementsAreTheTabulatedOnes) {
  const auto v = vectors()["likelihood_increments"];
  const int K = v["K"];
  FilterParameters parameters = wideLimits(v["accuracy"]);
  parameters.hitProbability = v["p_hit"];
  parameters.falseAlarmProbability = v["p_fa"];
  const ClassFilter<double> filter(K, parameters);
  const ClassBelief<double> prior = filter.uniform(0);
  ClassBelief<double> hit = prior, missed = prior, unlabeled = prior;
  filter.hit(hit, 7);
  filter.miss(missed);
  filter.hit(unlabeled);
  EXPECT_NEAR(hit.logOddsOf(7) - prior.rest, v["psi"].get<double>(), 1e-12);
  EXPECT_NEAR(hit.rest - prior.rest, v["phi_hit_other"].get<double>(), 1e-12);
  EXPECT_NEAR(missed.rest - prior.rest, v["phi_miss"].get<double>(), 1e-12);
  EXPECT_NEAR(std::exp(unlabeled.rest - prior.rest),
              v["mean_uniform_exp_increment_equals_phit_over_pfa"].get<double>(), 1e-12);
  const auto& expected = v["one_hit_from_occ_prior_0.5"];
  const std::vector<double> p = distributionOf(hit, K);
  EXPECT_NEAR(p[0], expected["p_free"].get<double>(), 1e-12);
  EXPECT_NEAR(p[7], expected["p_hit_class"].get<double>(), 1e-12);
  EXPECT_NEAR(p[1], expected["p_each_other"].get<double>(), 1e-12);
}
