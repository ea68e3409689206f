#include "core/identification/common_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace core {
namespace {

Mode drifting(double frequency_hz, double share_per_s, double std_share_per_s) {
  Mode mode;
  mode.frequency_hz = frequency_hz;
  mode.history.emplace();
  mode.history->drift_hz_per_s = share_per_s * frequency_hz;
  mode.history->drift_std_hz_per_s = std_share_per_s * frequency_hz;
  return mode;
}

TEST(CommonDrift, SeesWhatNoModeShowsAlone) {
  ModalEstimate estimate;
  for (const double f : {1.0, 2.0, 3.0, 4.0}) estimate.modes.push_back(drifting(f, 3e-5, 1e-5));
  const auto drift = common_drift(estimate);
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->share_per_s, 3e-5, 1e-15);
  EXPECT_NEAR(drift->std_per_s, 0.5e-5, 1e-15);  // of four equal ones
  EXPECT_TRUE(drift->drifts);
  EXPECT_EQ(drift->n_modes, 4U);
}

TEST(CommonDrift, TrustsTheModesByTheirVariances) {
  ModalEstimate estimate;
  estimate.modes = {drifting(1.0, 1e-5, 1e-5), drifting(9.0, 0.0, 3e-5)};
  EXPECT_NEAR(common_drift(estimate)->share_per_s, 0.9e-5, 1e-15);
}

TEST(CommonDrift, IsLessSureWhereTheModesDisagree) {
  ModalEstimate estimate;
  estimate.modes = {drifting(1.0, 9e-5, 1e-5), drifting(2.0, 0.0, 1e-5), drifting(3.0, 0.0, 1e-5)};
  const auto drift = common_drift(estimate);
  EXPECT_NEAR(drift->share_per_s, 3e-5, 1e-15);
  EXPECT_NEAR(drift->std_per_s, 3e-5, 1e-15);  // chi^2 = 54 with two degrees of freedom
  EXPECT_FALSE(drift->drifts);
}

TEST(CommonDrift, NeedsTwoModesWithATrendThatIsANumber) {
  ModalEstimate estimate;
  EXPECT_FALSE(common_drift(estimate));
  estimate.modes = {drifting(1.0, 1e-5, 1e-5), drifting(2.0, std::numeric_limits<double>::quiet_NaN(), 1e-5),
                    drifting(3.0, 1e-5, 0.0), Mode{}};
  EXPECT_FALSE(common_drift(estimate));
}

}  // namespace
}  // namespace core
