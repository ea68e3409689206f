#include "core/identification/record_poles.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace core {

namespace {

constexpr double kLeastPresence = 0.25;  // poles found in fewer orders are over-modelling artefacts: no verdict
// Of a line that is close to another one: share of the orders, and damping ratio.
constexpr double kLeastClosePresence = 0.8, kMostCloseDamping = 0.05;

std::vector<int> orders_from(int first, const Realisation& realisation) {
  std::vector<int> orders;
  for (int k = 0; k < kMostOrders && first + 2 * k <= realisation.a.rows(); ++k) orders.push_back(first + 2 * k);
  return orders;
}

double apparent_hz(const DiscretePole& pole, double rate_hz) {
  return std::abs(std::arg(pole.lambda)) * rate_hz / (2.0 * std::numbers::pi);
}

void add_poles_of_orders(const FoldingConfig& folding, const CameraLeakage& camera, RecordPoles& out) {
  for (std::size_t i = 0; i < out.orders.size(); ++i) {
    std::vector<DiscretePole> found = poles_of_order(out.fit.realisation, out.orders[i]);
    std::vector<std::vector<std::complex<double>>> shapes;
    for (const DiscretePole& pole : found) {
      const double hz = apparent_hz(pole, folding.rate_hz);
      shapes.push_back(camera.without(pole.shape, hz, camera.examine(pole.shape, hz).is_doubtful));
    }
    UnfoldedOrder unfolded = unfold_order(found, shapes, folding);
    for (std::size_t k = 0; k < found.size(); ++k) {
      out.unfolded.push_back({static_cast<int>(i), std::move(unfolded.poles[k])});
      out.observed.push_back({out.orders[i], std::move(found[k])});
      out.leaks.push_back(std::move(unfolded.leaks[k]));
    }
  }
}

std::vector<PoleCluster> lines_of(const std::vector<OrderPole>& poles, int n_orders) {
  std::vector<PoleCluster> lines = cluster_poles(poles, n_orders);
  join_alternating_lines(lines, n_orders);
  join_split_lines(lines, n_orders);
  std::erase_if(lines, [](const PoleCluster& line) { return line.presence < kLeastPresence; });
  return lines;
}

RecordPoles poles_of(const CpsdSums& sums, const IdentifierConfig& config, const std::vector<ChannelInfo>& channels,
                     const FoldingConfig& folding, const CameraLeakage& camera) {
  RecordPoles out;
  out.status = fit_model(sums, config, channels, out.fit);
  if (out.status != "ok") return out;
  out.orders = orders_from(out.fit.order, out.fit.realisation);
  add_poles_of_orders(folding, camera, out);
  out.lines = config.as_published ? lines_of_one_order(out.unfolded)
                                  : lines_of(out.unfolded, static_cast<int>(out.orders.size()));
  return out;
}

bool are_close(const PoleCluster& a, const PoleCluster& b) {
  const auto width_hz = [](const PoleCluster& line) { return line.damping_ratio * line.frequency_hz; };
  const auto counts = [](const PoleCluster& line) {
    return line.presence >= kLeastClosePresence && line.damping_ratio > 0.0 && line.damping_ratio < kMostCloseDamping;
  };
  return counts(a) && counts(b) && std::abs(a.apparent_hz - b.apparent_hz) < width_hz(a) + width_hz(b);
}

bool has_close_lines(const std::vector<PoleCluster>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      if (are_close(lines[i], lines[j])) return true;
    }
  }
  return false;
}

}  // namespace

RecordPoles find_poles(const CpsdSums& sums, const IdentifierConfig& config, const std::vector<ChannelInfo>& channels,
                       const FoldingConfig& folding, const CameraLeakage& camera) {
  RecordPoles out = poles_of(sums, config, channels, folding, camera);
  if (config.as_published || out.status != "ok" || !out.fit.order_is_clear) return out;
  const int longer = longer_block_rows(sums, config, out.fit, channels);
  if (longer == 0 || !has_close_lines(out.lines)) return out;
  IdentifierConfig with_longer = config;
  with_longer.block_rows = longer;
  RecordPoles resolved = poles_of(sums, with_longer, channels, folding, camera);
  return resolved.status == "ok" ? std::move(resolved) : std::move(out);
}

}  // namespace core
