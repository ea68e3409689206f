#pragma once

#include <cstddef>
#include <vector>

#include "core/identification/folding.h"

namespace core {

// One pole of one model order.
struct OrderPole {
  int i_order = 0;  // index into the list of orders
  UnfoldedPole pole;
};

// Poles of different orders that represent one mode: a vertical line of the stabilisation diagram.
struct PoleCluster {
  double frequency_hz = 0.0;  // medians over the members
  double apparent_hz = 0.0;
  double damping_ratio = 0.0;
  int first_i_order = 0;             // the lowest order in which it was found
  double presence = 0.0;             // share of the orders in which it was found
  std::vector<int> i_orders;         // those orders, ascending
  std::vector<std::size_t> members;  // indices of its poles
  std::size_t i_representative = 0;  // the member nearest the medians
  UnfoldedPole representative;
};

// Average-linkage clustering on |df| / (0.015 f) + (1 - MAC) / 0.3, cut at 1 (METHOD.md).
[[nodiscard]] std::vector<PoleCluster> cluster_poles(const std::vector<OrderPole>& poles, int n_orders);

// Clusters of a single order: every pole is a line of its own.
[[nodiscard]] std::vector<PoleCluster> lines_of_one_order(const std::vector<OrderPole>& poles);

// A model with more states than the record supports splits one mode into two lines of one shape (MAC > 0.95 within 3
// %). The line found in more orders receives the orders of the other one, so that the split does not reduce its
// presence.
void join_split_lines(std::vector<PoleCluster>& clusters, int n_orders);

// One pole whose shape contains more or less of a neighbour's from order to order forms several clusters: none of them
// shares an order with another, and their frequencies agree (a quarter of the half-power width, 0.3 % at most). They
// become one line, with frequency, damping and shape of that cluster whose components are most in phase (MPC).
void join_alternating_lines(std::vector<PoleCluster>& clusters, int n_orders);

[[nodiscard]] double damping_ratio(std::complex<double> s) noexcept;  // -Re s / |s|
[[nodiscard]] double frequency_hz(std::complex<double> s) noexcept;   // |s| / (2 pi)

}  // namespace core
