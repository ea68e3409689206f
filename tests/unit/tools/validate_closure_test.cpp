#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_structures.h"
#include "tools/validate/drawn_scene.h"

namespace tools {
namespace {

core::closure::ClosureStep step_of(const std::string& effect, std::vector<core::closure::ParameterValue> parameters) {
  core::closure::ClosureStep step;
  step.effect = effect;
  step.parameters = std::move(parameters);
  return step;
}

TEST(ClosureEffects, DrawTheirOwnNumbersFromTheSeed) {
  for (const HiddenEffect& effect : hidden_effects()) {
    std::set<double> values;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const core::simulation::Scene declared = draw_scene(seed, 20.0).scene;
      core::simulation::Scene scene = declared;
      effect.set(scene, effect.start);
      const std::vector<KnownValue> truth = effect.truth(scene, declared);
      ASSERT_FALSE(truth.empty()) << effect.name;
      for (const KnownValue& known : truth) EXPECT_TRUE(std::isfinite(known.value)) << effect.name;
      values.insert(truth.front().value);
    }
    if (effect.name == "pixel locking") continue;
    EXPECT_GT(values.size(), 1U) << effect.name << ": signs, frequencies, courses";
  }
}

TEST(ClosureEffects, TurnTheCameraAsFarAsAskedAboveFiveHertz) {
  core::simulation::Scene scene = draw_scene(2, 60.0).scene;
  const HiddenEffect& effect = effect_named("roll above 5 Hz");
  effect.set(scene, 0.02);
  EXPECT_NEAR(effect.truth(scene, scene).front().value, 0.02, 0.003);
  double slow = 0.0, n = 0.0;  // mean over a second: nothing below 5 Hz is left
  const auto& roll = scene.flight->roll_rad;
  for (std::size_t k = 0; k + 200 < roll.size(); k += 200, ++n) {
    double mean = 0.0;
    for (std::size_t i = 0; i < 200; ++i) mean += roll[k + i] / 200.0;
    slow += mean * mean;
  }
  EXPECT_LT(std::sqrt(slow / n) * 180.0 / 3.14159265, 0.002);
}

TEST(ClosureEffects, JudgeEveryKnownParameterAndTakeNoneForGranted) {
  const std::vector<KnownValue> truth{{"p1", 1.0}, {"p2", -2.0}};
  const auto good = step_of("lens", {{"p1", "", 1.1, 0.1}, {"p2", "", -2.2, 0.1}, {"other", "", 5.0, 0.1}});
  const ParameterErrors errors = parameter_errors({good}, "lens", truth);
  EXPECT_NEAR(errors.worst_sigmas, 2.0, 1e-9) << "of the second, not of the first";
  EXPECT_NEAR(errors.first, 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(parameter_errors({good}, "roll", truth).worst_sigmas)) << "not named";
  const auto lacks = step_of("lens", {{"p1", "", 1.0, 0.1}});
  EXPECT_TRUE(std::isinf(parameter_errors({lacks}, "lens", truth).worst_sigmas)) << "not stated";
  const auto unsure = step_of("lens", {{"p1", "", 1.0, 0.1}, {"p2", "", -2.0, std::nullopt}});
  EXPECT_TRUE(std::isinf(parameter_errors({unsure}, "lens", truth).worst_sigmas)) << "no sigma";
}

TEST(ClosureStructures, DifferBySeedAndFromTheUniformFrame) {
  for (const std::string& effect : known_structures()) {
    std::set<std::size_t> storeys;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const KnownStructure with = known_structure(effect, seed), plain = known_structure("none", seed);
      ASSERT_EQ(with.frequency_hz.size(), plain.frequency_hz.size());
      storeys.insert(with.frequency_hz.size());
      double off = 0.0;
      for (std::size_t i = 0; i < with.frequency_hz.size(); ++i) {
        if (i > 0) {
          EXPECT_GT(with.frequency_hz[i], with.frequency_hz[i - 1]) << effect;
        }
        off = std::max(off, std::abs(with.frequency_hz[i] / plain.frequency_hz[i] - 1.0));
      }
      EXPECT_EQ(off > 0.01, effect != "none") << effect << ", seed " << seed;
      EXPECT_EQ(with.truth.empty(), effect == "none");
    }
    EXPECT_GE(storeys.size(), 3U) << effect;
  }
}

}  // namespace
}  // namespace tools
