#include "core/identification/mode_sigmas.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <utility>

#include "core/identification/block_deviations.h"
#include "core/identification/hankel_changes.h"
#include "core/linear/median.h"
#include "core/types/constants.h"

namespace core {

namespace {

// Correlation of the power of two half-overlapping Hann-windowed segments: overlap of the squared windows,
// integral of w(t)^2 w(t + 1/2)^2 over that of w^4 = (3/128) / (35/128).
constexpr double kOverlapCorrelation = 3.0 / 35.0;

// Median absolute deviation, for normal errors the standard deviation, squared.
double robust_variance(std::vector<double> deviation) {
  if (deviation.empty()) return 0.0;
  for (double& d : deviation) d = std::abs(d);
  return std::pow(kSigmaPerMad * median_in_place(deviation), 2);
}

// By the overlap of neighbouring segments: a factor of variances.
void raise(ModeScatter& scatter, double factor) {
  const double root = std::sqrt(factor);
  scatter.frequency_hz *= root, scatter.damping_ratio *= root, scatter.beside_line *= factor;
  for (auto* sigmas : {&scatter.shape, &scatter.along}) {
    for (double& sigma : *sigmas) sigma *= root;
  }
}

double raised(double sigma, double spread, double bound) { return std::sqrt(std::max(sigma * sigma + spread, bound)); }

void state(const ModeScatter& scatter, const ModeVariances& spread, const ModeVariances& bound, Mode& mode) {
  mode.frequency_std_hz = raised(scatter.frequency_hz, spread.frequency_hz, bound.frequency_hz);
  mode.damping_std = raised(scatter.damping_ratio, spread.damping_ratio, bound.damping_ratio);
  mode.shape_std = scatter.shape;
}

}  // namespace

ModeVariances least_variances(const Mode& mode, double duration_s) {
  const double turns = kTwoPi * mode.frequency_hz * duration_s, zeta = std::max(0.0, mode.damping_ratio);
  if (!(turns > 0.0)) return {};
  return {mode.frequency_hz * mode.frequency_hz * zeta / turns, zeta / turns};
}

ModeVariances spread_over_orders(const PoleCluster& line, const std::vector<OrderPole>& poles) {
  std::map<int, std::complex<double>> of_order;
  const auto distance = [&](std::complex<double> s) { return std::abs(s - line.representative.s); };
  for (const std::size_t member : line.members) {
    const std::complex<double> s = poles[member].pole.s;
    const auto [at, is_first] = of_order.try_emplace(poles[member].i_order, s);
    if (!is_first && distance(s) < distance(at->second)) at->second = s;
  }
  std::vector<double> f, zeta;
  for (const auto& [order, s] : of_order) f.push_back(frequency_hz(s) - line.frequency_hz);
  for (const std::size_t member : line.members)
    zeta.push_back(damping_ratio(poles[member].pole.s) - line.damping_ratio);
  return {robust_variance(std::move(f)), robust_variance(std::move(zeta))};
}

// With r the correlation of neighbouring blocks, the variance of the sum of K is 1 + 2 r (K - 1) / K times the sum of
// their variances.
double overlap_factor(const CpsdSums& sums, double n_groups) {
  const double per_group = std::max(1.0, static_cast<double>(sums.n_segments) / n_groups);
  const double r = kOverlapCorrelation / (per_group + 2.0 * kOverlapCorrelation * (per_group - 1.0));
  return 1.0 + 2.0 * r * (n_groups - 1.0) / n_groups;
}

Sigmas state_sigmas(const SigmaInputs& in, const std::vector<PoleCluster>& lines, std::vector<Mode>& modes) {
  Sigmas out{0.0, std::vector<std::optional<ModeScatter>>(lines.size())};
  const std::size_t n_groups = std::min(kScatterBlocks, in.sums.n_blocks);
  if (n_groups < kLeastScatterBlocks) return out;
  std::vector<PoleOfOrder> chosen;
  std::vector<std::size_t> line_of;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (modes[i].verdict == Verdict::kNumerical) continue;
    chosen.push_back(in.observed[lines[i].i_representative]);
    line_of.push_back(i);
  }
  const auto deviations = block_deviations(in.sums, hankel_change_references(in.fit.era),
                                           hankel_change_lags(in.fit.era, in.fit.n_differences), n_groups);
  auto changes = pole_changes(in.fit.realisation, in.fit.era, deviations, chosen);
  const double factor = overlap_factor(in.sums, static_cast<double>(n_groups));
  const double duration_s = in.sums.n_remembered() / in.sums.rate_hz;
  // The bound is that of an unknown force; a measured input leaves none.
  const auto bound_of = [&](const Mode& mode) {
    return in.fit.era.inputs.empty() ? least_variances(mode, duration_s) : ModeVariances{};
  };
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const PoleCluster& line = lines[line_of[c]];
    std::vector<std::complex<double>>& shape = chosen[c].pole.shape;
    const double hz = std::abs(std::arg(chosen[c].pole.lambda)) * in.sums.rate_hz / kTwoPi;
    const bool leave = in.camera.examine(shape, hz).is_doubtful;
    const auto& leak = in.leaks[line.i_representative];
    const auto cleaned = [&](const std::vector<std::complex<double>>& of) {
      const auto kept = in.camera.without(of, hz, leave);
      return leak ? leak->without(kept) : kept;
    };
    shape = cleaned(shape);
    for (PoleChange& change : changes[c]) change.shape = cleaned(change.shape);
    std::optional<ModeScatter>& scatter = out.scatter[line_of[c]];
    scatter = mode_scatter(chosen[c], line.representative, in.folding, changes[c]);
    if (!scatter) continue;
    raise(*scatter, factor);
    Mode& mode = modes[line_of[c]];
    state(*scatter, spread_over_orders(line, in.unfolded), bound_of(mode), mode);
  }
  out.degrees_of_freedom = deviations.degrees_of_freedom;
  return out;
}

}  // namespace core
