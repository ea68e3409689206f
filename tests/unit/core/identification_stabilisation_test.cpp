#include "core/identification/stabilisation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace core {
namespace {

using Shape = std::vector<std::complex<double>>;

OrderPole pole(int i_order, double hz, double zeta, Shape shape) {
  OrderPole p;
  p.i_order = i_order;
  const double w = 2.0 * std::numbers::pi * hz;
  p.pole.s = {-zeta * w, w * std::sqrt(1.0 - zeta * zeta)};
  p.pole.apparent_hz = hz;
  p.pole.shape = std::move(shape);
  p.pole.mpc = 1.0;
  return p;
}

const Shape kFirst{0.3, 0.7, 1.0};
const Shape kSecond{1.0, 0.4, -0.8};

TEST(Stabilisation, PutsPolesOfDifferentOrdersIntoOneColumn) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 10; ++i) {
    poles.push_back(pole(i, 5.0 + 0.002 * i, 0.01, kSecond));
    poles.push_back(pole(i, 2.0 - 0.001 * i, 0.02, kFirst));
  }
  const std::vector<PoleCluster> clusters = cluster_poles(poles, 10);
  ASSERT_EQ(clusters.size(), 2U);
  EXPECT_NEAR(clusters[0].frequency_hz, 2.0, 0.01);
  EXPECT_NEAR(clusters[0].damping_ratio, 0.02, 1e-9);
  EXPECT_NEAR(clusters[1].frequency_hz, 5.01, 0.01);
  EXPECT_EQ(clusters[0].presence, 1.0);
  EXPECT_EQ(clusters[0].first_i_order, 0);
}

TEST(Stabilisation, CountsTheOrdersInWhichAPoleWasFound) {
  const std::vector<PoleCluster> clusters = cluster_poles({pole(3, 2.0, 0.01, kFirst), pole(5, 2.0, 0.01, kFirst),
                                                           pole(5, 2.001, 0.01, kFirst), pole(7, 2.0, 0.01, kFirst)},
                                                          12);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_EQ(clusters[0].presence, 3.0 / 12.0) << "two poles of one order count once";
  EXPECT_EQ(clusters[0].first_i_order, 3);
}

TEST(Stabilisation, OneFrequencyWithTwoShapesIsTwoModes) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 6; ++i) {
    poles.push_back(pole(i, 4.00, 0.01, kFirst));
    poles.push_back(pole(i, 4.01, 0.01, kSecond));
  }
  EXPECT_EQ(cluster_poles(poles, 6).size(), 2U);
}

TEST(Stabilisation, OneShapeAtTwoFrequenciesIsTwoModes) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 6; ++i) {
    poles.push_back(pole(i, 4.0, 0.01, kFirst));
    poles.push_back(pole(i, 4.1, 0.01, kFirst));
  }
  EXPECT_EQ(cluster_poles(poles, 6).size(), 2U);
}

TEST(Stabilisation, TheMediansShrugOffOneStrayPole) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 9; ++i) poles.push_back(pole(i, 4.0, 0.01, kFirst));
  poles.push_back(pole(9, 4.05, 0.05, kFirst));
  const std::vector<PoleCluster> clusters = cluster_poles(poles, 10);
  ASSERT_EQ(clusters.size(), 1U);
  EXPECT_NEAR(clusters[0].frequency_hz, 4.0, 1e-9);
  EXPECT_NEAR(damping_ratio(clusters[0].representative.s), 0.01, 1e-9);
}

// Orders with different alias orders must not be mixed: frequency, alias order and shape belong together.
TEST(Stabilisation, FrequencyAndFoldBelongTogether) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 15; ++i) {
    const bool folded = i % 2 == 0;  // 8 of 15
    const double scatter = 0.003 * std::sin(1.0 + 2.0 * i);
    OrderPole p = pole(i, 12.07 + scatter, 0.01, kFirst);
    // The odd ones are nearer to the median of all in everything except the alias order.
    if (folded) p.pole.s = pole(i, 12.93 - scatter, 0.0093 + 0.002 * std::sin(0.4 * i), kFirst).pole.s;
    p.pole.fold_n = folded ? -1 : 0;
    p.pole.fold_margin = 0.1;
    poles.push_back(p);
  }
  const std::vector<PoleCluster> clusters = cluster_poles(poles, 15);
  ASSERT_EQ(clusters.size(), 1U);
  ASSERT_TRUE(clusters[0].representative.fold_n.has_value());
  EXPECT_EQ(*clusters[0].representative.fold_n, -1);
  EXPECT_NEAR(clusters[0].frequency_hz, 12.93, 0.004);
  EXPECT_NEAR(frequency_hz(clusters[0].representative.s), clusters[0].frequency_hz, 0.008);
  EXPECT_EQ(clusters[0].presence, 1.0) << "the pole is there in every order, whatever its fold";
}

// A pole that wanders slightly with the order falls into two clusters; together they are one mode.
TEST(Stabilisation, JoinsALineThatWasSplit) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 10; ++i) {
    poles.push_back(pole(i, i < 6 ? 4.0 : 4.07, 0.01, kFirst));
    poles.push_back(pole(i, 4.02, 0.01, kSecond));
    poles.push_back(pole(i, 4.3, 0.01, kFirst));
  }
  std::vector<PoleCluster> clusters = cluster_poles(poles, 10);
  ASSERT_EQ(clusters.size(), 4U);
  join_split_lines(clusters, 10);
  ASSERT_EQ(clusters.size(), 3U) << "neither another shape nor another frequency is joined";
  for (const PoleCluster& cluster : clusters) {
    EXPECT_EQ(cluster.presence, 1.0);
    EXPECT_EQ(cluster.first_i_order, 0);
    EXPECT_NE(cluster.frequency_hz, 4.07) << "the part of more orders gives the numbers";
  }
}

// The shape of one pole holds more of a neighbour's in some orders, and less in others.
TEST(Stabilisation, JoinsALineWhoseShapeAlternates) {
  std::vector<OrderPole> poles;
  for (int i = 0; i < 10; ++i) {
    OrderPole one = pole(i, 4.0, 0.01, i % 3 == 0 ? kSecond : kFirst);
    one.pole.mpc = i % 3 == 0 ? 0.95 : 0.6;
    poles.push_back(one);
    poles.push_back(pole(i, 4.2, 0.01, i % 3 == 0 ? kSecond : kFirst));
    poles.push_back(pole(i, 4.21, 0.01, i % 3 == 0 ? kFirst : kSecond));
    poles.push_back(pole(i, i % 3 == 0 ? 6.0 : 6.05, 0.01, i % 3 == 0 ? kSecond : kFirst));
    poles.push_back(pole(i, i % 3 == 0 ? 8.0 : 8.05, 0.06, i % 3 == 0 ? kSecond : kFirst));
  }
  std::vector<PoleCluster> clusters = cluster_poles(poles, 10);
  const std::size_t n_before = clusters.size();
  join_alternating_lines(clusters, 10);
  const auto at = [&](double hz) {
    std::vector<PoleCluster> out;
    std::copy_if(clusters.begin(), clusters.end(), std::back_inserter(out),
                 [hz](const PoleCluster& line) { return std::abs(line.apparent_hz - hz) < 0.06; });
    return out;
  };
  ASSERT_EQ(at(4.0).size(), 1U);
  EXPECT_EQ(at(4.0)[0].presence, 1.0);
  EXPECT_EQ(at(4.0)[0].members.size(), 10U);
  EXPECT_NEAR(at(4.0)[0].representative.mpc, 0.95, 1e-12) << "the shape that is more in phase";
  EXPECT_EQ(at(6.0).size(), 2U) << "another frequency is another pole";
  EXPECT_EQ(at(8.0).size(), 2U) << "and so it is within a wide pole's width";
  EXPECT_EQ(clusters.size(), n_before - 1) << "poles of the same orders are two";
}

TEST(Stabilisation, NoPolesGiveNoClusters) { EXPECT_TRUE(cluster_poles({}, 15).empty()); }

TEST(PoleFacts, FrequencyAndDampingOfAContinuousPole) {
  const std::complex<double> s = pole(0, 7.5, 0.03, {}).pole.s;
  EXPECT_NEAR(frequency_hz(s), 7.5, 1e-12);
  EXPECT_NEAR(damping_ratio(s), 0.03, 1e-12);
  EXPECT_NEAR(damping_ratio(-std::conj(s)), -0.03, 1e-12);
}

}  // namespace
}  // namespace core
