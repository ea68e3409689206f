#include "core/closure/observation/rungs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace core::closure {
namespace {

constexpr std::size_t kAtOnce = 64;  // cosines

}  // namespace

Rungs::Rungs(double rate_hz) : rate_hz_(rate_hz) {
  const double half_hz = 0.5 * rate_hz;
  for (const double edge_hz : {0.0, 0.25, 0.5}) {
    if (edge_hz < half_hz) edges_hz_.push_back(edge_hz);
  }
  const double width_hz = std::max(1.0, std::ceil(half_hz / static_cast<double>(kMost - 3)));
  for (double edge_hz = width_hz; edge_hz + 0.5 * width_hz < half_hz; edge_hz += width_hz) edges_hz_.push_back(edge_hz);
  edges_hz_.push_back(half_hz);
}

std::size_t Rungs::of(double hz) const noexcept {
  const auto above = std::upper_bound(edges_hz_.begin(), edges_hz_.end(), hz);
  const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - edges_hz_.begin() - 1, 0));
  return std::min(at, size() - 1);
}

RungSet Rungs::up_to(double hz) const noexcept {
  RungSet out = 0;
  for (std::size_t i = 0; i < size() && to_hz(i) <= hz; ++i) out |= RungSet{1} << i;
  return out;
}

double Rungs::width_hz(RungSet set) const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += holds(set, i) ? to_hz(i) - from_hz(i) : 0.0;
  return sum;
}

double Rungs::highest_hz(RungSet set) const noexcept {
  double out = 0.0;
  for (std::size_t i = 0; i < size(); ++i) out = holds(set, i) ? to_hz(i) : out;
  return out;
}

double Rungs::lowest_hz(RungSet set) const noexcept {
  for (std::size_t i = 0; i < size(); ++i) {
    if (holds(set, i)) return from_hz(i);
  }
  return 0.0;
}

std::vector<Eigen::Index> Rungs::orders(Eigen::Index n_frames, RungSet set) const {
  const auto n = static_cast<double>(n_frames);
  std::vector<Eigen::Index> out;
  for (Eigen::Index m = 0; m < n_frames; ++m) {
    if (holds(set, of(0.5 * rate_hz_ * static_cast<double>(m) / n))) out.push_back(m);
  }
  return out;
}

Eigen::MatrixXd Rungs::cosines(Eigen::Index n_frames, std::span<const Eigen::Index> orders) {
  const auto n = static_cast<double>(n_frames);
  Eigen::MatrixXd out(n_frames, static_cast<Eigen::Index>(orders.size()));
  for (Eigen::Index c = 0; c < out.cols(); ++c) {
    const auto m = static_cast<double>(orders[static_cast<std::size_t>(c)]);
    const double scale = std::sqrt((m == 0.0 ? 1.0 : 2.0) / n);
    for (Eigen::Index k = 0; k < n_frames; ++k)
      out(k, c) = scale * std::cos(std::numbers::pi * m * (static_cast<double>(k) + 0.5) / n);
  }
  return out;
}

Eigen::MatrixXd Rungs::cosines(Eigen::Index n_frames, RungSet set) const {
  return cosines(n_frames, orders(n_frames, set));
}

void Rungs::for_cosines(Eigen::Index n_frames, std::span<const Eigen::Index> orders,
                        const std::function<void(Eigen::Index, const Eigen::MatrixXd&)>& use) {
  for (std::size_t from = 0; from < orders.size(); from += kAtOnce) {
    const auto some = orders.subspan(from, std::min(kAtOnce, orders.size() - from));
    use(static_cast<Eigen::Index>(from), cosines(n_frames, some));
  }
}

}  // namespace core::closure
