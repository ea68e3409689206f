#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/closure/observation/adoption.h"

namespace core::closure {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ClosureStep step(const std::string& effect, double value, double sigma = 1e-4) {
  ClosureStep out;
  out.effect = effect, out.id.key = effect;
  std::replace(out.id.key.begin(), out.id.key.end(), ' ', '_');
  out.parameters = {{"k1", "", value, sigma}};
  out.heldout_before = 0.05, out.heldout_after = 0.03;
  return out;
}

ClosureReport report(std::uint64_t first, std::uint64_t last, std::vector<ClosureStep> steps) {
  ClosureReport out;
  out.first_sequence = first, out.last_sequence = last;
  out.result.unit = "px";
  out.result.steps = std::move(steps);
  return out;
}

TEST(Adoption, OneReportIsNotEnoughAndTwoThatAgreeAre) {
  Adoption a;
  EXPECT_THAT(a.update(report(0, 999, {step("radial distortion", -0.07)}), 1500), IsEmpty());
  EXPECT_THAT(a.in_force(), IsEmpty());
  EXPECT_THAT(a.update(report(500, 1499, {step("radial distortion", -0.0702)}), 2000),
              ElementsAre(AllOf(HasSubstr("from frame 2000 on taken out, radial distortion"), HasSubstr("k1 = -0.0702"),
                                HasSubstr("held-out error 0.0500 -> 0.0300 px"))));
  ASSERT_EQ(a.in_force().size(), 1U);
  const PointCorrection places = a.correction({2000.0, 2000.0, 960.0, 540.0, {}}).places;
  EXPECT_EQ(places.lens.distortion[0], -0.0702);
  EXPECT_EQ(places.lens.fx, 2000.0);
  EXPECT_THAT(a.words(), ElementsAre(HasSubstr("from frame 2000 on")));
}

TEST(Adoption, NumbersThatStillChangeWait) {
  Adoption a;
  EXPECT_THAT(a.update(report(0, 999, {step("radial distortion", -0.02)}), 1500), IsEmpty());
  EXPECT_THAT(a.update(report(500, 1499, {step("radial distortion", -0.07)}), 2000), IsEmpty());
  EXPECT_EQ(a.update(report(1000, 1999, {step("radial distortion", -0.07)}), 2500).size(), 1U);
}

TEST(Adoption, WhatHasRivalsIsLatentOrFreeInEveryFrameIsLeftAlone) {
  Adoption a;
  ClosureStep rivalled = step("radial distortion", -0.07), latent = step("latent 1", 0.1);
  rivalled.rivals = {"camera pitch"};
  latent.kind = EffectKind::kLatent;
  for (std::uint64_t k = 0; k < 3; ++k) {
    EXPECT_THAT(a.update(report(500 * k, 500 * k + 999, {rivalled, latent, step("camera roll", 0.02)}), 5000),
                IsEmpty());
  }
}

TEST(Adoption, IsWithdrawnByFramesThatAllCameAfterItAndDoNotShowIt) {
  Adoption a;
  (void)a.update(report(0, 999, {step("pixel locking", 0.04)}), 1500);
  ASSERT_EQ(a.update(report(500, 1499, {step("pixel locking", 0.04)}), 2000).size(), 1U);
  EXPECT_EQ(a.correction({}).places.locking_px[0], 0.04);
  EXPECT_THAT(a.update(report(1000, 1999, {}), 2500), IsEmpty());  // half of its frames are older
  EXPECT_THAT(a.update(report(2000, 2999, {}), 3500),
              ElementsAre(AllOf(HasSubstr("from frame 3500 on withdrawn, pixel locking"), HasSubstr("2000 to 2999"))));
  EXPECT_FALSE(a.correction({}).places.corrects());
}

TEST(Adoption, OtherNumbersTwiceReplaceTheOld) {
  Adoption a;
  for (const double value : {0.5, 0.5}) (void)a.update(report(0, 999, {step("readout time", value)}), 1000);
  EXPECT_EQ(a.correction({}).added_readout.value, 0.5);
  EXPECT_THAT(a.update(report(0, 999, {step("readout time", 0.7)}), 2000), IsEmpty());
  EXPECT_THAT(a.update(report(0, 999, {step("readout time", 0.7)}), 3000), ElementsAre(HasSubstr("new numbers")));
  EXPECT_EQ(a.correction({}).added_readout.value, 0.7);
  EXPECT_EQ(a.in_force().size(), 1U);
}

TEST(Adoption, AReadoutTimeThatWasThereFromTheStartChangesNoDelays) {
  Adoption there, later;
  for (int i = 0; i < 2; ++i) (void)there.update(report(0, 999, {step("readout time", 0.5)}), 1000);
  ASSERT_EQ(there.in_force().size(), 1U);
  EXPECT_FALSE(there.changes_delays());  // only the constants of the channels change
  (void)later.update(report(0, 999, {}), 1000);
  for (int i = 0; i < 2; ++i) (void)later.update(report(500, 1499, {step("readout time", 0.5)}), 2000);
  ASSERT_EQ(later.in_force().size(), 1U);
  EXPECT_TRUE(later.changes_delays());
  (void)later.update(report(2000, 2999, {step("readout time", 0.5)}), 3000);
  EXPECT_FALSE(later.changes_delays());
  ASSERT_EQ(later.update(report(2500, 3499, {}), 4000).size(), 1U);  // withdrawn
  EXPECT_TRUE(later.changes_delays());
}

TEST(Adoption, ALensChangesNoDelays) {
  Adoption a;
  (void)a.update(report(0, 999, {}), 1000);
  for (int i = 0; i < 2; ++i) (void)a.update(report(500, 1499, {step("radial distortion", -0.07)}), 2000);
  ASSERT_EQ(a.in_force().size(), 1U);
  EXPECT_FALSE(a.changes_delays());
}

TEST(Adoption, ARefusedReportChangesNothing) {
  Adoption a;
  for (int i = 0; i < 2; ++i) (void)a.update(report(0, 999, {step("readout time", 0.5)}), 1000);
  ClosureReport refused = report(2000, 2999, {});
  refused.refused = "too short";
  EXPECT_THAT(a.update(refused, 4000), IsEmpty());
  EXPECT_EQ(a.in_force().size(), 1U);
}

}  // namespace
}  // namespace core::closure
