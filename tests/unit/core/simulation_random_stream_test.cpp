#include "core/simulation/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace core::simulation {
namespace {

std::vector<double> gaussians(RandomStream stream, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(stream.gaussian());
  return values;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
  return ab / std::sqrt(aa * bb);
}

TEST(RandomStream, RepeatsItselfForTheSameSeedNameAndIndex) {
  EXPECT_EQ(gaussians({7, "noise", 3}, 100), gaussians({7, "noise", 3}, 100));
}

TEST(RandomStream, DiffersWithoutCorrelationForAnotherSeedNameOrIndex) {
  constexpr int kN = 40000;
  const auto reference = gaussians({7, "noise", 3}, kN);
  for (const RandomStream& other : {RandomStream(8, "noise", 3), RandomStream(7, "noisf", 3),
                                    RandomStream(7, "noise", 4), RandomStream(3, "noise", 7)}) {
    EXPECT_LT(std::abs(correlation(reference, gaussians(other, kN))), 4.5 / std::sqrt(kN));
  }
}

TEST(RandomStream, HasTheMomentsOfAGaussian) {
  constexpr int kN = 400000;
  double sum = 0.0, sum2 = 0.0, sum3 = 0.0, sum4 = 0.0;
  for (const double x : gaussians({1, "moments"}, kN))
    sum += x, sum2 += x * x, sum3 += x * x * x, sum4 += x * x * x * x;
  EXPECT_NEAR(sum / kN, 0.0, 4.5 / std::sqrt(kN));
  EXPECT_NEAR(sum2 / kN, 1.0, 4.5 * std::sqrt(2.0 / kN));
  EXPECT_NEAR(sum3 / kN, 0.0, 4.5 * std::sqrt(15.0 / kN));
  EXPECT_NEAR(sum4 / kN, 3.0, 4.5 * std::sqrt(96.0 / kN));
}

TEST(RandomStream, IsUniformOverTheUnitInterval) {
  RandomStream stream(1, "uniform");
  std::vector<int> bins(16);
  constexpr int kN = 160000;
  for (int i = 0; i < kN; ++i) {
    const double u = stream.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++bins[static_cast<std::size_t>(u * 16.0)];
  }
  for (const int n : bins) EXPECT_NEAR(n, kN / 16, 5.0 * std::sqrt(kN / 16.0));
}

// Numbers that every platform must produce: they fix generator, seeding and logarithm.
TEST(RandomStream, GivesTheSameNumbersOnEveryPlatform) {
  RandomStream stream(1, "golden");
  EXPECT_EQ(stream.next(), 0xBB9F6719DAE5BB63ULL);
  EXPECT_EQ(stream.gaussian(), -0x1.b593b7463bf8dp+0);
  EXPECT_EQ(stream.gaussian(), -0x1.0067f777acf7bp-2);
}

}  // namespace
}  // namespace core::simulation
