#include "core/identification/readout_from_shapes.h"

#include <algorithm>
#include <cmath>

#include "core/identification/mac.h"
#include "core/types/constants.h"

namespace core {

namespace {

using Complex = std::complex<double>;
constexpr double kStep_frames = 0.005;  // step of the search; the maximum is about 0.1 wide
constexpr double kLeastRowShare = 0.05;
constexpr double kLeastShapeStd = 0.003;  // relative to the largest component, 1

struct Fold {
  double mpc = 0.0, frequency_hz = 0.0;
};

Fold best_fold(const ObservedPole& pole, std::span<const double> row_share, double readout_s,
               const ReadoutSearch& search) {
  const double limit_hz = std::max(search.max_frequency_hz, 0.5 * search.rate_hz);
  const int reach = static_cast<int>(std::ceil(limit_hz / search.rate_hz)) + 1;
  std::vector<Complex> shape(pole.shape.size());
  Fold best{0.0, pole.apparent_hz};
  for (int n = -reach; n <= reach; ++n) {
    const double f = pole.apparent_hz + n * search.rate_hz;
    if (std::abs(f) > limit_hz) continue;
    for (std::size_t c = 0; c < shape.size(); ++c) {
      shape[c] = pole.shape[c] * std::polar(1.0, -kTwoPi * f * readout_s * row_share[c]);
    }
    const double value = mpc(shape);
    if (value > best.mpc) best = {value, f};
  }
  return best;
}

// MPC of every pole (rows) at every readout time of the search (columns).
class MpcTable {
 public:
  MpcTable(std::span<const ObservedPole> poles, std::span<const double> row_share, const ReadoutSearch& search)
      : n_poles_(poles.size()),
        half_(static_cast<int>(std::lround(search.most_frames / kStep_frames))),
        n_steps_(static_cast<std::size_t>(2 * half_ + 1)) {
    for (const ObservedPole& pole : poles) {
      for (std::size_t k = 0; k < n_steps_; ++k) {
        mpc_.push_back(best_fold(pole, row_share, readout_frames(static_cast<double>(k)) / search.rate_hz, search).mpc);
      }
    }
  }

  [[nodiscard]] double readout_frames(double step) const noexcept { return (step - half_) * kStep_frames; }
  // Mean over all poles except `without` (n_poles(): over all).
  [[nodiscard]] double mean(std::size_t step, std::size_t without) const noexcept {
    double sum = 0.0;
    for (std::size_t p = 0; p < n_poles_; ++p) sum += p == without ? 0.0 : mpc_[p * n_steps_ + step];
    return sum / static_cast<double>(without < n_poles_ ? n_poles_ - 1 : n_poles_);
  }
  // Readout of the largest mean, in frames, by a parabola through the three best steps.
  [[nodiscard]] double maximum_frames(std::size_t without) const noexcept {
    const std::size_t k = best_step(without);
    if (k == 0 || k + 1 == n_steps_) return readout_frames(static_cast<double>(k));
    const double a = mean(k - 1, without), b = mean(k, without), c = mean(k + 1, without);
    const double bend = a - 2.0 * b + c;
    return readout_frames(static_cast<double>(k) + (bend < 0.0 ? 0.5 * (a - c) / bend : 0.0));
  }
  [[nodiscard]] std::size_t best_step(std::size_t without) const noexcept {
    std::size_t best = 0;
    for (std::size_t k = 1; k < n_steps_; ++k) {
      if (mean(k, without) > mean(best, without)) best = k;
    }
    return best;
  }
  [[nodiscard]] std::size_t n_poles() const noexcept { return n_poles_; }

 private:
  std::size_t n_poles_;
  int half_;
  std::size_t n_steps_;
  std::vector<double> mpc_;
};

// Information of one pole about the readout, per frame^2: regression of its components' phases on the row share with
// free intercept, phase sigma s_c / |phi_c|. Empty if the sigma of a component is unknown.
std::optional<double> information_of(const ObservedPole& pole, std::span<const double> row_share, double frequency_hz,
                                     double rate_hz) {
  if (pole.shape_std.size() != pole.shape.size()) return {};
  double weight = 0.0, share = 0.0, squares = 0.0;
  for (std::size_t c = 0; c < pole.shape.size(); ++c) {
    // The component to which the shape is scaled has no sigma of its own.
    const double scatter = std::max(pole.shape_std[c], kLeastShapeStd);
    if (!std::isfinite(scatter)) return {};
    const double w = std::norm(pole.shape[c]) / (scatter * scatter);
    weight += w;
    share += w * row_share[c];
    squares += w * row_share[c] * row_share[c];
  }
  if (!(weight > 0.0)) return {};
  const double turn = kTwoPi * frequency_hz / rate_hz;  // radians per frame of readout
  return turn * turn * std::max(0.0, squares - share * share / weight);
}

bool usable(std::span<const ObservedPole> poles, std::span<const double> row_share, const ReadoutSearch& search) {
  if (poles.size() < 2 || row_share.size() < 3 || !(search.rate_hz > 0.0) || !(search.most_frames > 0.0)) return false;
  const auto [low, high] = std::minmax_element(row_share.begin(), row_share.end());
  return *high - *low >= kLeastRowShare && std::all_of(poles.begin(), poles.end(), [&](const ObservedPole& pole) {
    return pole.shape.size() == row_share.size() && std::isfinite(pole.apparent_hz);
  });
}

}  // namespace

ObservedPole observed_pole(const Mode& mode, const std::vector<ChannelInfo>& channels, double rate_hz) {
  const double signed_hz = mode.apparent_hz + mode.fold_n.value_or(0) * rate_hz;
  ObservedPole pole{mode.apparent_hz, mode.shape, mode.shape_std};
  for (std::size_t c = 0; c < pole.shape.size() && c < channels.size(); ++c) {
    pole.shape[c] = (signed_hz < 0.0 ? std::conj(pole.shape[c]) : pole.shape[c]) *
                    std::polar(1.0, kTwoPi * signed_hz * channels[c].row_delay_s);
  }
  return pole;
}

std::optional<ReadoutFromShapes> readout_from_shapes(std::span<const ObservedPole> poles,
                                                     std::span<const double> row_share, const ReadoutSearch& search) {
  if (!usable(poles, row_share, search)) return {};
  const MpcTable table(poles, row_share, search);
  const std::size_t n = table.n_poles();
  ReadoutFromShapes out;
  out.readout_frames = table.maximum_frames(n);
  out.mean_mpc = table.mean(table.best_step(n), n);
  out.n_poles = static_cast<int>(n);
  std::vector<double> without;
  double mean = 0.0, squares = 0.0;
  for (std::size_t p = 0; p < n; ++p) {
    without.push_back(table.maximum_frames(p));
    mean += without.back() / static_cast<double>(n);
  }
  for (const double value : without) squares += (value - mean) * (value - mean);
  out.std_frames = std::sqrt(squares * static_cast<double>(n - 1) / static_cast<double>(n));
  double information = 0.0;
  int n_known = 0;
  for (const ObservedPole& pole : poles) {
    const Fold fold = best_fold(pole, row_share, out.readout_frames / search.rate_hz, search);
    const auto known = information_of(pole, row_share, fold.frequency_hz, search.rate_hz);
    information += known.value_or(0.0);
    n_known += known ? 1 : 0;
  }
  out.scatter_known = n_known >= 2 && information > 0.0;
  if (out.scatter_known) out.std_frames = std::max(out.std_frames, 1.0 / std::sqrt(information));
  return out;
}

}  // namespace core
