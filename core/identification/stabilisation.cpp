#include "core/identification/stabilisation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "core/identification/average_linkage.h"
#include "core/identification/mac.h"
#include "core/linear/median.h"

namespace core {

namespace {

constexpr double kStableFrequencyTolerance = 0.015;  // relative
constexpr double kStableMacTolerance = 0.3;
constexpr double kFarApart = 2.0;
constexpr double kSplitFrequency = 0.03;  // relative
constexpr double kSplitMac = 0.95;
constexpr double kAlternating = 0.5;  // of half the half-power width
// Relative. Poles of noise are heavily damped: a share of their width alone joins them by chance.
constexpr double kAlternatingFrequency = 0.003;

double frequency_distance(const UnfoldedPole& a, const UnfoldedPole& b) noexcept {
  const double mean_hz = 0.5 * (a.apparent_hz + b.apparent_hz);
  return std::abs(a.apparent_hz - b.apparent_hz) / (kStableFrequencyTolerance * mean_hz);
}

// Distance matrix of the poles with indices `members`, in that order.
std::vector<double> distances(const std::vector<OrderPole>& poles, const std::vector<std::size_t>& members) {
  const std::size_t n = members.size();
  std::vector<double> norm(n), all(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::complex<double>& z : poles[members[i]].pole.shape) norm[i] += std::norm(z);
  }
  const auto distance = [&](std::size_t i, std::size_t j) {
    const UnfoldedPole &a = poles[members[i]].pole, &b = poles[members[j]].pole;
    const double df = frequency_distance(a, b);
    if (df >= 1.0) return kFarApart;
    double re = 0.0, im = 0.0;  // inner product of two shapes
    for (std::size_t c = 0; c < a.shape.size() && c < b.shape.size(); ++c) {
      re += a.shape[c].real() * b.shape[c].real() + a.shape[c].imag() * b.shape[c].imag();
      im += a.shape[c].real() * b.shape[c].imag() - a.shape[c].imag() * b.shape[c].real();
    }
    const double mac = norm[i] > 0.0 && norm[j] > 0.0 ? (re * re + im * im) / (norm[i] * norm[j]) : 0.0;
    return df + (1.0 - mac) / kStableMacTolerance;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) all[i * n + j] = all[j * n + i] = distance(i, j);
  }
  return all;
}

// Groups of poles between frequency gaps too wide for a cluster: all distances across a gap exceed the cut, so that no
// cluster spans it. Members ascend.
std::vector<std::vector<std::size_t>> bands(const std::vector<OrderPole>& poles) {
  std::vector<std::size_t> by_frequency(poles.size());
  std::iota(by_frequency.begin(), by_frequency.end(), std::size_t{0});
  std::sort(by_frequency.begin(), by_frequency.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(poles[a].pole.apparent_hz, a) < std::pair(poles[b].pole.apparent_hz, b);
  });
  std::vector<std::vector<std::size_t>> all;
  for (std::size_t i = 0; i < by_frequency.size(); ++i) {
    const UnfoldedPole& pole = poles[by_frequency[i]].pole;
    if (i == 0 || frequency_distance(poles[by_frequency[i - 1]].pole, pole) >= 1.0) all.emplace_back();
    all.back().push_back(by_frequency[i]);
  }
  for (std::vector<std::size_t>& band : all) std::sort(band.begin(), band.end());
  return all;
}

// Orders may disagree on the alias order. Frequency, damping and shape must belong to one alias order: the most
// frequent.
std::vector<std::size_t> of_commonest_fold(const std::vector<OrderPole>& poles,
                                           const std::vector<std::size_t>& members) {
  std::map<std::optional<int>, std::vector<std::size_t>> by_fold;
  for (const std::size_t m : members) by_fold[poles[m].pole.fold_n].push_back(m);
  return std::max_element(by_fold.begin(), by_fold.end(),
                          [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); })
      ->second;
}

PoleCluster summarise(const std::vector<OrderPole>& poles, const std::vector<std::size_t>& members, int n_orders) {
  std::vector<double> frequencies, apparents, dampings;
  std::set<int> orders;
  for (const std::size_t m : members) orders.insert(poles[m].i_order);
  const std::vector<std::size_t> agreeing = of_commonest_fold(poles, members);
  for (const std::size_t m : agreeing) {
    frequencies.push_back(frequency_hz(poles[m].pole.s));
    apparents.push_back(poles[m].pole.apparent_hz);
    dampings.push_back(damping_ratio(poles[m].pole.s));
  }
  PoleCluster cluster;
  cluster.frequency_hz = median(frequencies);
  cluster.apparent_hz = median(apparents);
  cluster.damping_ratio = median(dampings);
  cluster.i_orders.assign(orders.begin(), orders.end());
  cluster.members = members;
  cluster.first_i_order = *orders.begin();
  cluster.presence = static_cast<double>(orders.size()) / n_orders;
  const auto off = [&](std::size_t m) {
    const UnfoldedPole& pole = poles[m].pole;
    return std::abs(pole.apparent_hz / cluster.apparent_hz - 1.0) +
           std::abs(damping_ratio(pole.s) - cluster.damping_ratio);
  };
  const auto nearest =
      std::min_element(agreeing.begin(), agreeing.end(), [&](auto a, auto b) { return off(a) < off(b); });
  cluster.i_representative = *nearest;
  cluster.representative = poles[*nearest].pole;
  return cluster;
}

void take_members(PoleCluster& line, const PoleCluster& other, int n_orders) {
  std::set<int> orders(line.i_orders.begin(), line.i_orders.end());
  orders.insert(other.i_orders.begin(), other.i_orders.end());
  line.i_orders.assign(orders.begin(), orders.end());
  line.members.insert(line.members.end(), other.members.begin(), other.members.end());
  line.first_i_order = line.i_orders.front();
  line.presence = static_cast<double>(orders.size()) / n_orders;
}

bool in_other_orders(const PoleCluster& a, const PoleCluster& b) {
  std::vector<int> both;
  std::set_intersection(a.i_orders.begin(), a.i_orders.end(), b.i_orders.begin(), b.i_orders.end(),
                        std::back_inserter(both));
  return both.empty();
}

}  // namespace

void join_split_lines(std::vector<PoleCluster>& clusters, int n_orders) {
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const auto& a, const auto& b) { return a.presence > b.presence; });
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    PoleCluster& line = clusters[i];
    const auto is_split = [&](const PoleCluster& other) {
      return std::abs(other.apparent_hz / line.apparent_hz - 1.0) < kSplitFrequency &&
             mac(other.representative.shape, line.representative.shape) > kSplitMac;
    };
    for (std::size_t j = clusters.size(); j-- > i + 1;) {
      if (!is_split(clusters[j])) continue;
      take_members(line, clusters[j], n_orders);
      clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

void join_alternating_lines(std::vector<PoleCluster>& clusters, int n_orders) {
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const auto& a, const auto& b) { return a.representative.mpc > b.representative.mpc; });
  const auto near_hz = [](const PoleCluster& a, const PoleCluster& b) {
    const double damping = std::min(std::abs(a.damping_ratio), std::abs(b.damping_ratio));
    return std::min(kAlternating * damping, kAlternatingFrequency) * a.apparent_hz;
  };
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    PoleCluster& line = clusters[i];
    for (std::size_t j = i + 1; j < clusters.size();) {
      const bool is_one = std::abs(clusters[j].apparent_hz - line.apparent_hz) < near_hz(line, clusters[j]) &&
                          in_other_orders(line, clusters[j]);
      if (!is_one) {
        ++j;
        continue;
      }
      take_members(line, clusters[j], n_orders);
      clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

double damping_ratio(std::complex<double> s) noexcept { return -s.real() / std::abs(s); }
double frequency_hz(std::complex<double> s) noexcept { return std::abs(s) / (2.0 * std::numbers::pi); }

std::vector<PoleCluster> lines_of_one_order(const std::vector<OrderPole>& poles) {
  std::vector<PoleCluster> lines;
  for (std::size_t i = 0; i < poles.size(); ++i) lines.push_back(summarise(poles, {i}, 1));
  return lines;
}

std::vector<PoleCluster> cluster_poles(const std::vector<OrderPole>& poles, int n_orders) {
  std::vector<PoleCluster> clusters;
  for (const std::vector<std::size_t>& band : bands(poles)) {
    for (std::vector<std::size_t>& members : average_linkage(distances(poles, band), band.size(), 1.0)) {
      for (std::size_t& member : members) member = band[member];
      clusters.push_back(summarise(poles, members, n_orders));
    }
  }
  std::sort(clusters.begin(), clusters.end(),
            [](const PoleCluster& a, const PoleCluster& b) { return a.apparent_hz < b.apparent_hz; });
  return clusters;
}

}  // namespace core
