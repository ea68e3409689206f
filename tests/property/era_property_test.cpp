#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/identification/era.h"
#include "core/identification/mac.h"
#include "tests/support/random_system.h"

namespace core {
namespace {

using test_support::RandomSystem;

void recover(unsigned seed, bool canonical_variates) {
  const int n_modes = 1 + static_cast<int>(seed % 5);
  const int n_channels = 2 + static_cast<int>(seed % 4);
  const RandomSystem system(seed, n_modes, n_channels);
  EraConfig config;
  config.block_rows = 14;
  config.first_lag = 1 + static_cast<int>(seed % 3);
  config.canonical_variates = canonical_variates;
  config.references = {0, n_channels - 1};
  Realisation realisation;
  ASSERT_EQ(realise(system.correlations(40), config, realisation), EraStatus::kOk);
  const std::vector<DiscretePole> found = poles_of_order(realisation, 2 * n_modes);
  ASSERT_EQ(static_cast<int>(found.size()), n_modes);
  for (const RandomSystem::Pole& truth : system.poles) {
    const auto nearest =
        std::min_element(found.begin(), found.end(), [&](const DiscretePole& a, const DiscretePole& b) {
          return std::abs(a.lambda - truth.lambda) < std::abs(b.lambda - truth.lambda);
        });
    EXPECT_LT(std::abs(nearest->lambda - truth.lambda), 1e-6);
    EXPECT_GT(mac(nearest->shape, truth.shape), 1.0 - 1e-6);
  }
}

TEST(EraProperty, RecoversRandomStableSystemsFromExactCorrelations) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    for (const bool canonical_variates : {false, true}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + (canonical_variates ? " canonical variates" : " plain"));
      recover(seed, canonical_variates);
    }
  }
}

}  // namespace
}  // namespace core
