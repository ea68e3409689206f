#include "core/identification/modal_coherence.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/identification/era.h"
#include "tests/support/random_system.h"

namespace core {
namespace {

using Complex = std::complex<double>;

TEST(OutputEmac, IsOneWhereTheEndFollowsFromTheBeginning) {
  const Complex decay = std::polar(0.3, 2.0);
  EXPECT_NEAR(output_emac({1.0, {0.5, 0.2}}, {decay, Complex(0.5, 0.2) * decay}, decay), 1.0, 1e-12);
}

TEST(OutputEmac, FallsWithTheRatioAndWithThePhase) {
  EXPECT_NEAR(output_emac({1.0}, {0.5}, 1.0), 0.5, 1e-12);
  EXPECT_NEAR(output_emac({1.0}, {2.0}, 1.0), 0.5, 1e-12);
  EXPECT_NEAR(output_emac({1.0}, {std::polar(1.0, 0.125 * std::numbers::pi)}, 1.0), 0.5, 1e-12);
  EXPECT_NEAR(output_emac({1.0}, {-1.0}, 1.0), 0.0, 1e-12);
  // The channel that moves three times as much counts nine times.
  EXPECT_NEAR(output_emac({3.0, 1.0}, {3.0, -1.0}, 1.0), 0.9, 1e-12);
}

TEST(OutputEmac, IsZeroWhereThereIsNothing) {
  EXPECT_EQ(output_emac({}, {}, 1.0), 0.0);
  EXPECT_EQ(output_emac({0.0}, {1.0}, 1.0), 0.0);
  EXPECT_EQ(output_emac({1.0}, {std::numeric_limits<double>::quiet_NaN()}, 1.0), 0.0);
}

TEST(OutputEmac, TellsThePolesOfASystemFromThoseOfAnOrderTooLow) {
  const test_support::RandomSystem system(6, 3, 4);
  for (const bool canonical_variates : {true, false}) {
    EraConfig config;
    config.block_rows = 12;
    config.references = {0, 1, 2, 3};
    config.canonical_variates = canonical_variates;
    Realisation realisation;
    ASSERT_EQ(realise(system.correlations(40), config, realisation), EraStatus::kOk);
    for (const DiscretePole& pole : poles_of_order(realisation, 6)) EXPECT_GT(pole.emac, 0.999);
    double least = 1.0;
    for (const DiscretePole& pole : poles_of_order(realisation, 4)) least = std::min(least, pole.emac);
    EXPECT_LT(least, 0.95);
  }
}

}  // namespace
}  // namespace core
