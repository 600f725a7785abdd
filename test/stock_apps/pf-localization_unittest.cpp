#include <cmath>
#include <regex>

#include "StockApps.h"

namespace {

class PfLocalization : public StockApps {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_APP("pf-localization");
    SKIP_WITHOUT("/usr/share/mrpt/datasets/localization_demo.simplemap.gz", "mrpt-common");
  }
  CommandRun localize() const {
    return run("pf-localization config/stock-apps/pf-localization.ini", Plugin::Preloaded);
  }
};

struct Estimate {
  double x = NAN, y = NAN, degrees = NAN;
};

/** The last one that the application told. */
Estimate lastEstimate(const std::string& output) {
  static const std::regex pattern(R"(PDF estimation: \(([-\d.]+),([-\d.]+),([-\d.]+)deg\))");
  Estimate last;
  for (std::sregex_iterator it(output.begin(), output.end(), pattern), end; it != end; ++it)
    last = {std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3])};
  return last;
}

/** The end of the path, which MRPT's own tests know: (15.904, -10.010) m, 4.93 degrees. */
double distanceToEnd(const Estimate& e) { return std::hypot(e.x - 15.904, e.y + 10.010); }

}  // namespace

TEST_F(PfLocalization, theParticlesFindTheRobotInASemanticOctreeOfARealBuilding) {
  const CommandRun localized = localize();
  ASSERT_EQ(localized.status, 0) << localized.output;
  ASSERT_TRUE(mapIn("pf-localization-output_000_0005000"));
  const Estimate end = lastEstimate(localized.output);
  EXPECT_LT(distanceToEnd(end), 0.3);
  EXPECT_NEAR(end.degrees, 4.93, 2);
}
