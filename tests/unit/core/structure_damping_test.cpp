#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "core/structure/damping_law.h"

namespace core::structure {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<ReferenceMode> damped(const std::vector<double>& hz, const std::vector<double>& ratio, double share) {
  std::vector<ReferenceMode> out;
  for (std::size_t i = 0; i < hz.size(); ++i) {
    ReferenceMode mode;
    mode.frequency_hz = hz[i], mode.damping_ratio = ratio[i], mode.damping_sigma = share * ratio[i];
    out.push_back(mode);
  }
  return out;
}

TEST(DampingLaws, EachIsToldFromItsOwnRatios) {
  const std::vector<double> hz{0.8, 3.0, 9.0, 20.0};
  const auto told = [&](auto law, double share) {
    std::vector<double> ratio;
    for (const double f : hz) ratio.push_back(law(f));
    return damping_verdict(damped(hz, ratio, share));
  };
  const auto mass = told([](double f) { return 0.01 / f; }, 0.1);
  EXPECT_THAT(mass.possible(), ElementsAre(DampingLaw::kMassProportional));
  EXPECT_NEAR(mass.laws[0].hz, 0.01, 1e-9);
  EXPECT_NEAR(mass.laws[0].hz_sigma, 0.01 * 0.1 / 2.0, 1e-9);  // four modes of 10 % each
  EXPECT_THAT(damping_words(mass), HasSubstr("damping of 4 modes over frequency: viscous, mass-proportional"));
  const auto stiff = told([](double f) { return 0.001 * f; }, 0.1);
  EXPECT_THAT(stiff.possible(), ElementsAre(DampingLaw::kStiffnessProportional));
  EXPECT_THAT(told([](double) { return 0.01; }, 0.05).possible(), ElementsAre(DampingLaw::kConstant));
  const auto both = told([](double f) { return 0.01 / f + 0.001 * f; }, 0.05);
  EXPECT_THAT(both.possible(), ElementsAre(DampingLaw::kRayleigh));
  EXPECT_NEAR(both.laws[3].per_hz, 0.001, 1e-9);
  EXPECT_LT(both.laws[3].heldout_percent, 1e-6);
}

TEST(DampingLaws, WhereSigmasDoNotAllowItNoneIsTold) {
  const std::vector<double> hz{1.0, 1.2, 1.4};
  const auto wide = damping_verdict(damped(hz, {0.01, 0.0105, 0.0098}, 0.3));
  EXPECT_GT(wide.possible().size(), 1U);
  EXPECT_THAT(damping_words(wide), HasSubstr("cannot be told apart"));
  const auto few = damping_verdict(damped({1.0, 9.0}, {0.01, 0.01}, 0.1));
  EXPECT_TRUE(few.laws.empty());
  EXPECT_THAT(damping_words(few), HasSubstr("fewer than 3 modes"));
  // A dip that no law has.
  const auto odd = damping_verdict(damped({1.0, 3.0, 9.0, 20.0}, {0.001, 0.05, 0.001, 0.05}, 0.05));
  EXPECT_TRUE(odd.possible().empty());
  EXPECT_THAT(damping_words(odd), HasSubstr("none of these mechanisms"));
  EXPECT_EQ(damping_words(damping_verdict({})), "");
}

}  // namespace
}  // namespace core::structure
