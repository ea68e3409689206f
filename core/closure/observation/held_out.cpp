#include "core/closure/observation/held_out.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

#include "core/closure/observation/row_spectra.h"
#include "core/linear/dense.h"

namespace core::closure {
namespace {

constexpr Eigen::Index kParts = 5;
constexpr Eigen::Index kSharedBins = 4;  // bins of the padded spectrum that share noise: in one part
constexpr double kMostRungs = 0.6;       // of the degrees of freedom: more is a pattern of all rungs

Eigen::MatrixXcd one_sided(const Eigen::MatrixXd& residual) {
  const int n_fft = row_fft_size(residual);
  Eigen::MatrixXcd out = row_spectra(residual, n_fft, std::sqrt(2.0 / n_fft));
  out.leftCols(1) *= std::sqrt(0.5), out.rightCols(1) *= std::sqrt(0.5);
  return out;
}

Eigen::MatrixXd real_gram(const Eigen::MatrixXcd& bins) { return gram(bins.real()) + gram(bins.imag()); }

Eigen::Index first_bin(const Rungs& rungs, std::size_t rung, Eigen::Index n_bins) {
  const double share = rungs.from_hz(rung) / rungs.to_hz(rungs.size() - 1);
  return static_cast<Eigen::Index>(std::ceil(share * static_cast<double>(n_bins - 1)));
}

// Columns of the spectrum in a band, by parts.
std::vector<Eigen::MatrixXcd> parts_of(const Eigen::MatrixXcd& spectrum, const Rungs& rungs, RungSet band) {
  std::vector<std::vector<Eigen::Index>> at(kParts);
  Eigen::Index n = 0;
  for (std::size_t rung = 0; rung < rungs.size(); ++rung) {
    if (!holds(band, rung)) continue;
    const Eigen::Index end = rung + 1 < rungs.size() ? first_bin(rungs, rung + 1, spectrum.cols()) : spectrum.cols();
    for (Eigen::Index b = first_bin(rungs, rung, spectrum.cols()); b < end; ++b)
      at[static_cast<std::size_t>(n++ / kSharedBins % kParts)].push_back(b);
  }
  std::vector<Eigen::MatrixXcd> out;
  out.reserve(at.size());
  for (const auto& columns : at) out.emplace_back(spectrum(Eigen::all, columns));
  return out;
}

}  // namespace

ResidualMoments residual_moments(const Eigen::MatrixXd& residual, double rate_hz) {
  ResidualMoments m;
  const Eigen::Index n = residual.cols(), rows = residual.rows();
  m.all_sum = Eigen::MatrixXd::Zero(rows, rows);
  for (Eigen::Index b = 0; b < kParts; ++b) {
    const Eigen::Index from = b * n / kParts, to = (b + 1) * n / kParts;
    m.all.push_back(gram(residual.middleCols(from, to - from)));
    m.all_sum += m.all.back();
  }
  m.spectrum = one_sided(residual);
  const Rungs rungs(rate_hz);
  for (std::size_t rung = 0; rung < rungs.size(); ++rung) {
    const Eigen::Index from = first_bin(rungs, rung, m.spectrum.cols());
    const Eigen::Index to = rung + 1 < rungs.size() ? first_bin(rungs, rung + 1, m.spectrum.cols()) : m.spectrum.cols();
    m.of_rung.push_back(real_gram(m.spectrum.middleCols(from, to - from)));
  }
  return m;
}

PatternBeside pattern_beside(const PointMotionModel& model, const Eigen::VectorXd& whitened) {
  const auto beside = [&](const Eigen::MatrixXd& q) -> Eigen::VectorXd {
    Eigen::VectorXd g = whitened - q * (q.transpose() * whitened);
    if (!(g.norm() > kLeastBeside * whitened.norm())) return Eigen::VectorXd::Zero(whitened.size());
    return g.normalized();
  };
  return {beside(model.q_low()), beside(model.q_high())};
}

HeldOut::HeldOut(const PointMotionModel& model, double rate_hz)
    : rungs_(rate_hz),
      band_(model.band()),
      orders_(rungs_.orders(model.n_frames(), band_)),
      high_(model.q_high()),
      low_(model.q_low()),
      within_share_(static_cast<double>(orders_.size()) / static_cast<double>(model.n_frames())),
      n_values_(static_cast<double>(high_.n_values()) * static_cast<double>(model.n_frames())),
      n_frames_(static_cast<double>(model.n_frames())) {}

double HeldOut::share_of(RungSet band) const {
  return std::min(rungs_.width_hz(band) / rungs_.to_hz(rungs_.size() - 1), 1.0);
}

double HeldOut::squares(const Eigen::MatrixXd& residual) const {
  Eigen::MatrixXd low = Eigen::MatrixXd::Zero(residual.rows(), static_cast<Eigen::Index>(orders_.size()));
  Rungs::for_cosines(residual.cols(), orders_, [&](Eigen::Index first, const Eigen::MatrixXd& cosines) {
    add_product(low.middleCols(first, cosines.cols()), 1.0, residual, cosines);
  });
  const Eigen::MatrixXd within = gram(low);
  return high_.squares(gram(residual) - within) + low_.squares(within);
}

double HeldOut::noise_variance() const {
  return (1.0 - within_share_) * high_.noise_variance() + within_share_ * low_.noise_variance();
}

double HeldOut::gain_in_rung(std::size_t rung, const PatternBeside& pattern, const ResidualMoments& moments) const {
  const LeaveOnePointOut& with = is_within(rung) ? low_ : high_;
  const Eigen::MatrixXd& m = moments.of_rung[rung];
  return with.squares(m) - with.squares_with(m, is_within(rung) ? pattern.within : pattern.above);
}

PatternGain HeldOut::of_pattern(const PatternBeside& pattern, const ResidualMoments& moments) const {
  PatternGain out;
  double all = 0.0;
  for (std::size_t rung = 0; rung < rungs_.size(); ++rung) {
    const double gain = gain_in_rung(rung, pattern, moments);
    all += gain;
    if (!(gain > kRungSigmas * std::sqrt(2.0 * freedom_in(rung)))) continue;
    out.gain += gain, out.band |= RungSet{1} << rung;
  }
  if (out.band == 0) return {all, kAllRungs};
  if (share_of(out.band) > kMostRungs) return {all, kAllRungs};
  return out;
}

Eigen::MatrixXd HeldOut::sum_over(RungSet band, const ResidualMoments& moments) const {
  if (band == kAllRungs) return moments.all_sum;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(moments.all_sum.rows(), moments.all_sum.cols());
  for (std::size_t rung = 0; rung < rungs_.size(); ++rung) {
    if (holds(band, rung)) sum += moments.of_rung[rung];
  }
  return sum;
}

double HeldOut::learned_gain(const std::vector<Eigen::MatrixXd>& parts, const LeaveOnePointOut& with,
                             const Eigen::MatrixXd& span) const {
  Eigen::MatrixXd sum = parts.front();
  for (std::size_t p = 1; p < parts.size(); ++p) sum += parts[p];
  double gain = 0.0;
  for (const Eigen::MatrixXd& part : parts) {
    const Eigen::MatrixXd others = sum - part;
    const Eigen::VectorXd g = span.cols() == 0
                                  ? leading_pattern(others)
                                  : (span * leading_pattern(Eigen::MatrixXd(span.transpose() * others * span))).eval();
    gain += with.squares(part) - with.squares_with(part, g);
  }
  return gain;
}

double HeldOut::of_learned_in(RungSet band, const ResidualMoments& moments, const Eigen::MatrixXd& span) const {
  const LeaveOnePointOut& with = (band & ~band_) == 0 ? low_ : high_;
  if (band == kAllRungs) return learned_gain(moments.all, high_, span);
  std::vector<Eigen::MatrixXd> parts;
  for (const Eigen::MatrixXcd& part : parts_of(moments.spectrum, rungs_, band)) parts.push_back(real_gram(part));
  return learned_gain(parts, with, span);
}

double HeldOut::of_learned_in(RungSet band, const ResidualMoments& moments) const {
  return of_learned_in(band, moments, Eigen::MatrixXd(moments.all_sum.rows(), 0));
}

RungSet HeldOut::strongest(const ResidualMoments& moments) const {
  std::size_t best = 0;
  double most = 0.0;
  for (std::size_t rung = 0; rung < rungs_.size(); ++rung) {
    const Eigen::VectorXd g = leading_pattern(moments.of_rung[rung]);
    const double excess = g.dot(moments.of_rung[rung] * g) - freedom_in(rung);
    if (excess > most) most = excess, best = rung;
  }
  return RungSet{1} << best;
}

PatternGain HeldOut::of_learned(const ResidualMoments& moments) const {
  PatternGain best{of_learned_in(kAllRungs, moments), kAllRungs};
  for (const RungSet band : {rungs_.up_to(PointMotionModel::kLowBand_hz), strongest(moments)}) {
    if (const double gain = of_learned_in(band, moments); gain > best.gain) best = {gain, band};
  }
  return best;
}

}  // namespace core::closure
