#include "core/closure/observation/aliased_motion.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <vector>

#include "core/closure/observation/point_motion_model.h"
#include "core/closure/observation/row_spectra.h"
#include "core/linear/dense.h"
#include "core/linear/median.h"
#include "core/linear/symmetric_eigen.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;

constexpr double kLeastAliasReadout_frames = 0.15;  // with a shorter readout the alias orders cannot be distinguished
constexpr double kStrip_hz = 0.25;
constexpr double kTopOfBand = 0.8;    // share of half the rate above which the level of the tail is estimated
constexpr double kTailOrder = 3.0;    // slowest decay of the spectrum of hover motion, f^-3
constexpr double kOverNoise = 1.15;   // factor over the noise that noise alone can reach
constexpr double kLeastPower = 0.05;  // smallest power of a direction that is used, in noise variances

}  // namespace

AliasedMotion::AliasedMotion(const FrameShift& shift, const Columns& columns, double rate_hz, double readout_frames)
    : shift_(shift), columns_(columns), rate_hz_(rate_hz), readout_frames_(readout_frames) {}

double AliasedMotion::rows_later(Index row, Index column) const {
  return columns_.model.geometry().share(row / 2) - columns_.share(column);
}

Eigen::VectorXd AliasedMotion::beside(const Eigen::VectorXd& field_px) const {
  const Eigen::VectorXd field = columns_.model.whitened(field_px);
  const Eigen::MatrixXd& q = columns_.model.q_high();
  return field - q * (q.transpose() * field);
}

std::vector<AliasStrip> AliasedMotion::strips(const Eigen::MatrixXd& amplitudes,
                                              const Eigen::MatrixXd& residual) const {
  Eigen::MatrixXd shear(columns_.n_regions, residual.cols()), moved = amplitudes.topRows(columns_.n_regions);
  Eigen::MatrixXd fields(residual.rows(), columns_.n_regions);
  for (Index r = 0; r < columns_.n_regions; ++r) {
    Eigen::VectorXd field = columns_.fields_px.col(r);
    for (Index i = 0; i < field.size(); ++i) field(i) *= rows_later(i, r);
    fields.col(r) = beside(field);
    shear.row(r) = fields.col(r).transpose() * residual;
  }
  // Hann window: leakage from a peak does not have the phase of the peak. Zeros beyond the ends: in a continuation by
  // reflection time runs backwards, and a quarter of a period before becomes one after.
  for (Index k = 0; k < shear.cols(); ++k) {
    const double w = 1.0 - std::cos(kTwoPi * (static_cast<double>(k) + 0.5) / static_cast<double>(shear.cols()));
    shear.col(k) *= w, moved.col(k) *= w;
  }
  const Eigen::MatrixXcd seen = row_spectra(shear, shift_.n_fft()), spectra = row_spectra(moved, shift_.n_fft());
  const double scale = 2.0 / shift_.n_fft() / 1.5;  // mean square of the window: 1.5
  const auto width = std::max<Index>(1, static_cast<Index>(std::llround(kStrip_hz * shift_.n_fft() / rate_hz_)));
  std::vector<AliasStrip> out;
  for (Index from = 0; from < seen.cols(); from += width) {
    const Index count = std::min(width, seen.cols() - from);
    const Eigen::MatrixXcd a = spectra.middleCols(from, count), y = seen.middleCols(from, count);
    out.push_back({from, count, scale * (a * a.adjoint()), Complex(0.0, -scale) * (y * a.adjoint())});
  }
  split_by_order(out, gram(fields.transpose()), kTwoPi * readout_frames_);
  return out;
}

Eigen::MatrixXd AliasedMotion::folded(const Eigen::MatrixXd& amplitudes, const Eigen::MatrixXd& residual) const {
  if (std::abs(readout_frames_) < kLeastAliasReadout_frames || columns_.n_regions == 0) return {};
  const Eigen::MatrixXcd regions = shift_.spectra(amplitudes.topRows(columns_.n_regions));
  std::map<int, Eigen::MatrixXcd> of_order;
  for (const AliasStrip& strip : strips(amplitudes, residual)) {
    for (const AliasPart& part : strip.split) {
      Eigen::MatrixXcd& spectra =
          of_order.try_emplace(part.order, Eigen::MatrixXcd::Zero(regions.rows(), regions.cols())).first->second;
      spectra.middleCols(strip.from, strip.count) = part.share * regions.middleCols(strip.from, strip.count);
    }
  }
  if (of_order.empty()) return {};
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(residual.rows(), residual.cols());
  for (const auto& [n, spectra] : of_order) {
    const Eigen::MatrixXd in_phase = shift_.series(spectra), later = shift_.series(Complex(0.0, 1.0) * spectra);
    for (Index r = 0; r < columns_.n_regions; ++r) {
      for (Index i = 0; i < out.rows(); ++i) {
        const double x = columns_.fields_px(i, r);
        if (x == 0.0) continue;
        const double angle = kTwoPi * n * readout_frames_ * rows_later(i, r);
        out.row(i) += x * ((std::cos(angle) - 1.0) * in_phase.row(r) + std::sin(angle) * later.row(r));
      }
    }
  }
  return columns_.model.whitened(out);
}

void AliasedMotion::learn_tail(const Eigen::MatrixXd& amplitudes, const Eigen::VectorXd& noise,
                               const Eigen::MatrixXd& residual) {
  directions_.resize(0, 0);
  const Eigen::MatrixXcd spectra = shift_.spectra(amplitudes.topRows(columns_.n_own));
  const auto from = static_cast<Index>(kTopOfBand * static_cast<double>(spectra.cols()));
  const double freedom =
      static_cast<double>(residual.rows() - columns_.model.q_high().cols()) / static_cast<double>(residual.rows());
  const double squares =
      residual.squaredNorm() / static_cast<double>(residual.size()) / freedom;  // includes the tail's own squares
  std::vector<Eigen::VectorXd> fields;
  for (Index c = 0; c < columns_.n_own; ++c) {
    std::vector<double> power;
    for (Index k = from; k < spectra.cols(); ++k) power.push_back(std::norm(spectra(c, k)) / shift_.n_fft());
    const double level = median(std::move(power)) / std::numbers::ln2 - kOverNoise * squares * noise(c);
    if (!(level > 0.0)) continue;
    const bool region = c < columns_.n_regions;
    for (int order = 1; order <= (region ? 1 : 2); ++order) {
      // At order 2 the spectrum with the slowest decay has this share of its power at half the rate.
      const double share = order == 1 ? 1.0 : std::pow(3.0, -kTailOrder) + std::pow(5.0, -kTailOrder);
      Eigen::VectorXd sine = std::sqrt(level * share) * columns_.fields_px.col(c), cosine = sine;
      for (Index i = 0; i < sine.size(); ++i) {
        const double angle = kTwoPi * order * readout_frames_ * rows_later(i, c);
        sine(i) *= std::sin(angle), cosine(i) *= std::cos(angle);
      }
      fields.push_back(beside(sine));
      if (!region) fields.push_back(beside(cosine));
    }
  }
  if (fields.empty()) return;
  Eigen::MatrixXd tail(residual.rows(), static_cast<Index>(fields.size()));
  for (Index i = 0; i < tail.cols(); ++i) tail.col(i) = fields[static_cast<std::size_t>(i)];
  const SymmetricEigen eigen(gram(tail.transpose()));
  auto count = (eigen.values().array() > kLeastPower * squares).count();
  if (count == 0) return;
  power_ = eigen.values().head(count);
  directions_ = tail * eigen.leading_vectors(count) * power_.cwiseSqrt().cwiseInverse().asDiagonal();
  // Noise: the part of the residual outside the tail's directions.
  const auto n_free = static_cast<double>(residual.rows() - columns_.model.q_high().cols() - count);
  if (!(n_free > 0.0)) return;
  const double inside = (directions_.transpose() * residual).squaredNorm();
  power_ *= n_free * static_cast<double>(residual.cols()) / std::max(residual.squaredNorm() - inside, 1e-300);
}

// Alias order -1 comes from 2 - of_half, +1 from 2 + of_half.
Eigen::VectorXd AliasedMotion::change_at(double of_half) const {
  const double shape = std::pow(2.0 - of_half, -kTailOrder) + std::pow(2.0 + of_half, -kTailOrder);
  return (1.0 + shape * power_.array()).rsqrt() - 1.0;
}

void AliasedMotion::weigh(Eigen::MatrixXd& series) const {
  if (directions_.size() == 0) return;
  Eigen::MatrixXcd bins = shift_.spectra(directions_.transpose() * series);
  const auto half = static_cast<double>(bins.cols() - 1);
  for (Index k = 0; k < bins.cols(); ++k) bins.col(k).array() *= change_at(static_cast<double>(k) / half).array();
  series += directions_ * shift_.series(bins);
}

void AliasedMotion::weigh_at(double of_half, Eigen::MatrixXcd& fields) const {
  if (directions_.size() == 0) return;
  fields += directions_ * (change_at(of_half).asDiagonal() * (directions_.transpose() * fields)).eval();
}

}  // namespace core::closure
