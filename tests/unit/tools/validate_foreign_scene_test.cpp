#include "tools/validate/foreign_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/simulation/effects.h"
#include "tools/validate/closure_tracks_record.h"
#include "tools/validate/foreign_effects.h"

namespace tools {
namespace {

TEST(ForeignScene, IsAFunctionOfItsSeedAlone) {
  const ForeignScene a = draw_foreign_scene(7, 20.0, ""), same = draw_foreign_scene(7, 20.0, "");
  EXPECT_EQ(a.words, same.words);
  EXPECT_EQ(a.stated_px, same.stated_px);
  EXPECT_NE(a.words, draw_foreign_scene(8, 20.0, "").words);
}

TEST(ForeignScene, StaysWithinItsRangesAndReachesAllKinds) {
  std::set<std::string> shaken;
  std::set<bool> folds, background;
  double shallow = 9.0, steep = 0.0, least = 1.0, most = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const ForeignScene foreign = draw_foreign_scene(seed, 10.0, "");  // validated
    const auto& scene = foreign.scene;
    shaken.insert(foreign.shaken), folds.insert(foreign.n_folded > 0), background.insert(foreign.background);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shallow = std::min(shallow, scene.tailed_hover.order[axis]),
      steep = std::max(steep, scene.tailed_hover.order[axis]);
      EXPECT_GE(scene.tailed_hover.corner_hz[axis], 0.05);
      EXPECT_LE(scene.tailed_hover.corner_hz[axis], 0.5);
    }
    const double readout = scene.camera.readout_s * scene.camera.rate_hz;
    least = std::min(least, readout), most = std::max(most, readout);
    EXPECT_LE(readout, 1.0);
    EXPECT_GE(scene.structure.n_bodies(), 4);
    EXPECT_LE(scene.structure.n_bodies(), 8);
  }
  EXPECT_EQ(shaken, (std::set<std::string>{"table", "wind"}));
  EXPECT_EQ(folds.size(), 2U);
  EXPECT_EQ(background.size(), 2U);
  EXPECT_TRUE(shallow >= 3.0 && shallow < 3.1 && steep > 4.9 && steep <= 5.0);
  EXPECT_TRUE(least < 0.1 && most > 0.9);
}

TEST(ForeignScene, StatesOneSigmaThatIsNotThatOfThePoints) {
  const ForeignScene foreign = draw_foreign_scene(3, 2.0, "");
  const auto record = foreign_record(foreign.scene, foreign);
  EXPECT_EQ(std::set<double>(record.sigma_px.begin(), record.sigma_px.end()), std::set<double>{foreign.stated_px});
}

TEST(ForeignEffects, EachAddsSomethingThatTheDeclaredSceneLacks) {
  ForeignScene foreign = draw_foreign_scene(5, 2.0, "");
  foreign.background = true;
  foreign.scene.tailed_hover = {};  // takes long to compute
  foreign.scene.hover.x_rms_mm = foreign.scene.hover.y_rms_mm = foreign.scene.hover.z_rms_mm = 3.0;
  for (const ForeignEffect& effect : foreign_effects()) {
    const SizedScene sized = with_effects({&effect.effect}, foreign.scene, 1.0, foreign.background);
    const auto with = foreign_record(sized.scene, foreign), without = foreign_record(foreign.scene, foreign);
    ASSERT_EQ(with.u_px.cols(), without.u_px.cols()) << effect.effect.name;
    EXPECT_GT((with.u_px - without.u_px).norm() + (with.v_px - without.v_px).norm(), 0.0) << effect.effect.name;
    EXPECT_FALSE(effect.names.empty());
  }
}

core::closure::ClosureStep step(const std::string& name, bool latent = false) {
  core::closure::ClosureStep one;
  one.effect = name;
  one.kind = latent ? core::closure::EffectKind::kLatent : core::closure::EffectKind::kNamed;
  return one;
}

TEST(ForeignEffects, AnAnswerIsRightOnlyWhereEveryNameIsAndNothingElse) {
  const ForeignEffect &roll = foreign_effect_named("camera roll"), &readout = foreign_effect_named("readout time");
  EXPECT_EQ(answer_of({}, {&roll}), Answer::kNothing);
  EXPECT_EQ(answer_of({step("camera roll")}, {&roll}), Answer::kNamed);
  EXPECT_EQ(answer_of({step("camera roll"), step("rotor line")}, {&roll}), Answer::kMisnamed);
  EXPECT_EQ(answer_of({step("camera roll"), step("latent 1", true)}, {&roll}), Answer::kLatent);
  EXPECT_EQ(answer_of({step("latent 1", true)}, {&roll}), Answer::kLatent);
  EXPECT_EQ(answer_of({step("camera roll")}, {&roll, &readout}), Answer::kPart);
  EXPECT_EQ(answer_of({step("readout time"), step("camera roll")}, {&roll, &readout}), Answer::kNamed);
}

TEST(ForeignEffects, ErrorsAreCountedInStatedSigmas) {
  const ForeignEffect& readout = foreign_effect_named("readout time");
  auto named = step("readout time");
  named.parameters = {{"added readout", "frames", 0.3, 0.05}, {"of no truth", "px", 1.0, 1.0}};
  const auto errors = errors_in_sigmas({named}, readout, {{"added readout", 0.2}});
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NEAR(errors[0], 2.0, 1e-12);
}

}  // namespace
}  // namespace tools
