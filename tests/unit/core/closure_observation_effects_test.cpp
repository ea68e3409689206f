#include "core/closure/observation/effects/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace core::closure {
namespace {

using ::testing::ElementsAre;

std::vector<ParameterValue> values(std::vector<double> numbers) {
  std::vector<ParameterValue> out;
  for (const double number : numbers) out.push_back({"p", "", number, 0.1});
  return out;
}

TEST(ObservationCatalogue, EveryIdIsAKeyOfItsOwn) {
  std::set<std::string> keys;
  for (const auto& effect : observation_effects()) {
    const std::string key = effect->id().key;
    EXPECT_TRUE(keys.insert(key).second) << key;
    EXPECT_EQ(key.find(' '), std::string::npos) << key;
    EXPECT_EQ(observation_effect(effect->id()), effect.get());
  }
  EXPECT_EQ(observation_effect({"warp"}), nullptr);
}

TEST(ObservationCatalogue, OnlyConstantsAreCorrectedInFlight) {
  std::vector<std::string> corrected, delays;
  for (const auto& effect : observation_effects()) {
    if (effect->in_flight() == nullptr) continue;
    corrected.push_back(effect->id().key);
    if (effect->in_flight()->changes_row_delays()) delays.push_back(effect->id().key);
  }
  EXPECT_THAT(corrected, ElementsAre("readout_time", "radial_distortion", "tangential_distortion", "lens_distortion",
                                     "pixel_locking"));
  EXPECT_THAT(delays, ElementsAre("readout_time"));
}

TEST(InFlightCorrection, LensEffectsShareOneLens) {
  const CameraModel camera{2000.0, 1990.0, 960.0, 540.0, {}};
  RunCorrection out;
  observation_effect({"tangential_distortion"})->in_flight()->add_to(out, values({0.002, -0.001}), camera);
  observation_effect({"radial_distortion"})->in_flight()->add_to(out, values({-0.07}), camera);
  EXPECT_THAT(out.places.lens.distortion, ElementsAre(-0.07, 0.0, 0.002, -0.001, 0.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(out.places.lens.fx, 2000.0);
  EXPECT_EQ(out.places.lens.cy, 540.0);
}

TEST(InFlightCorrection, AnEffectOfSizeZeroCorrectsNothing) {
  RunCorrection out;
  for (const auto& effect : observation_effects()) {
    if (effect->in_flight() != nullptr) effect->in_flight()->add_to(out, values({0.0}), {});
  }
  EXPECT_FALSE(out.places.corrects());
  EXPECT_EQ(out.added_readout.value, 0.0);
}

TEST(InFlightCorrection, ReadoutAndLockingFillTheirOwnFields) {
  RunCorrection out;
  observation_effect({"pixel_locking"})->in_flight()->add_to(out, values({0.01, 0.02, 0.03, 0.04}), {});
  observation_effect({"readout_time"})->in_flight()->add_to(out, values({0.4}), {});
  EXPECT_THAT(out.places.locking_px, ElementsAre(0.01, 0.02, 0.03, 0.04));
  EXPECT_EQ(out.added_readout.value, 0.4);
  EXPECT_EQ(out.added_readout.sigma, 0.1);
}

}  // namespace
}  // namespace core::closure
