#include "drivers/camera/recording/repeats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace drivers {
namespace {

// Changes of a film shown at `rate` times its frames; repeats change by a twentieth of what others do.
std::vector<double> converted(const Cadence& cadence, int n_frames, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> change(0.5, 3.0);
  std::vector<double> out;
  for (int k = 0; k < n_frames; ++k) {
    const double usual = change(random);
    out.push_back(cadence.repeats(static_cast<std::uint64_t>(k)) ? 0.05 * usual : usual);
  }
  return out;
}

TEST(Repeats, FindsEveryUsualConversion) {
  for (const auto& [shown, of] : {std::pair{5, 6}, {4, 5}, {2, 5}, {1, 2}, {24, 25}, {5, 12}, {12, 25}}) {
    for (const int phase : {0, of / 2, of - 1}) {
      const auto found = find_cadence(converted({shown, of, phase}, 180, 5));
      ASSERT_TRUE(found.has_value()) << shown << " of " << of << ", phase " << phase;
      EXPECT_EQ(found->shown, shown);
      EXPECT_EQ(found->of, of);
      for (std::uint64_t k = 1; k < 180; ++k) {
        EXPECT_EQ(found->repeats(k), (Cadence{shown, of, phase}).repeats(k)) << k;
      }
    }
  }
}

TEST(Repeats, FindsNoConversionInAFilmWithoutOne) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    EXPECT_FALSE(find_cadence(converted({1, 1, 0}, 180, seed)).has_value()) << seed;
  }
  EXPECT_FALSE(find_cadence(std::vector<double>(180, 0.0)).has_value());
}

TEST(Repeats, ScatteredRepeatsAreNoConversion) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<double> changes = converted({1, 1, 0}, 180, seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 20; ++i) changes[random() % 180] = 0.01;
    EXPECT_FALSE(find_cadence(changes).has_value()) << seed;
  }
}

// 3 Hz at 25 frames a second, without noise: once in 25 frames the motion reverses between two equal frames.
TEST(Repeats, AMotionThatTurnsBackBetweenTwoEqualFramesIsNoConversion) {
  std::vector<double> place, changes, around;
  for (int k = 0; k < 180; ++k) place.push_back(std::cos(2.0 * std::numbers::pi * 3.0 * (k + 0.5) / 25.0));
  for (std::size_t k = 0; k < place.size(); ++k) {
    changes.push_back(k > 0 ? std::abs(place[k] - place[k - 1]) : 0.0);
    around.push_back(k > 1 && k + 1 < place.size() ? std::abs(place[k + 1] - place[k - 2]) : 0.0);
  }
  EXPECT_TRUE(find_cadence(changes).has_value()) << "changes alone look like 24 of 25";
  EXPECT_FALSE(find_cadence(changes, around).has_value());
}

}  // namespace
}  // namespace drivers
