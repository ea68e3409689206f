#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tools/validate/hanging_chain.h"

namespace tools {
namespace {

HangingChain level_chain() {
  HangingChain chain;
  chain.slope_deg = 0.0, chain.chord_m = 80.0, chain.mass_per_m_kg = 50.0, chain.tension_n = 4.0e6;
  return chain;
}

TEST(HangingChain, HasTheFrequenciesOfAStiffString) {
  HangingChain chain = level_chain();
  chain.ei_nm2 = 4.0e5;
  const ChainModes modes = chain_modes(chain, {0.25, 0.5}, 6);
  const double slender = chain.chord_m * std::sqrt(chain.tension_n / chain.ei_nm2);
  for (int n = 2; n <= 6; n += 2) {  // sag does not move the antisymmetric ones
    // Held ends (Morse & Ingard, Theoretical Acoustics, 5.1): 1 + 2 / slender + (4 + n^2 pi^2 / 2) / slender^2.
    const double stiff =
        1.0 + 2.0 / slender + (4.0 + 0.5 * n * n * std::numbers::pi * std::numbers::pi) / (slender * slender);
    const double hz = n / (2.0 * chain.chord_m) * std::sqrt(chain.tension_n / chain.mass_per_m_kg) * stiff;
    EXPECT_NEAR(modes.frequency_hz(n - 1) / hz, 1.0, 1e-4) << n;
  }
  EXPECT_NEAR(modes.shapes(1, 1) / modes.shapes(0, 1), 0.0, 1e-6);
}

TEST(HangingChain, SagsByItsWeightOverItsTension) {
  const HangingChain chain = level_chain();
  const double sag = chain.mass_per_m_kg * 9.80665 * chain.chord_m * chain.chord_m / (8.0 * chain.tension_n);
  EXPECT_NEAR(chain_modes(chain, {0.5}, 2).sag_m / sag, 1.0, 1e-3);
}

TEST(HangingChain, SagRaisesTheFirstModeAsIrvineAndCaugheyGive) {
  HangingChain slack = level_chain(), taut = level_chain();
  slack.tension_n = 1.0e6, slack.chord_m = 150.0, taut = slack;
  taut.ea_n = 3.0e7;  // a soft cable has no restraint from its sag
  slack.ei_nm2 = taut.ei_nm2 = 1e3;
  const double weight = slack.mass_per_m_kg * 9.80665, bow = weight * slack.chord_m / slack.tension_n;
  const auto first = [&](const HangingChain& chain) {
    const double lambda2 = bow * bow * chain.ea_n / chain.tension_n / (1.0 + bow * bow / 8.0);
    // tan(w / 2) = w / 2 - 4 / lambda2 (w / 2)^3, its root between pi and 3 pi, by bisection.
    double low = std::numbers::pi * (1.0 + 1e-12), high = 2.999 * std::numbers::pi;
    const auto f = [&](double w) {
      return std::sin(w / 2) - std::cos(w / 2) * (w / 2 - 4.0 / lambda2 * std::pow(w / 2, 3));
    };
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      ((f(middle) > 0.0) == (f(low) > 0.0) ? low : high) = middle;
    }
    return low / (2.0 * std::numbers::pi * chain.chord_m) * std::sqrt(chain.tension_n / chain.mass_per_m_kg);
  };
  EXPECT_NEAR(chain_modes(slack, {0.5}, 3).frequency_hz.minCoeff() / std::min(first(slack), 1e9), 1.0, 0.02);
  EXPECT_NEAR(chain_modes(taut, {0.5}, 3).frequency_hz(0) / first(taut), 1.0, 2e-3);
}

TEST(HangingChain, FindsNoRestUnderATensionLessThanItsWeight) {
  HangingChain chain = level_chain();
  chain.tension_n = 10.0;
  EXPECT_THROW((void)chain_modes(chain, {0.5}, 2), std::runtime_error);
}

}  // namespace
}  // namespace tools
