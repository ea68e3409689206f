#include "core/closure/observation/line_search.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/closure/observation/power_quantiles.h"
#include "core/closure/observation/row_spectra.h"
#include "core/linear/dense.h"
#include "core/spectrum/real_fft.h"

namespace core::closure {
namespace {

constexpr std::array<double, 4> kHalfWidth_hz{3.0, 2.0, 1.0, 0.3};
constexpr double kFoldWidth_hz = 1.0;   // half width of the band in which the alias order is estimated
constexpr double kLeastOverSlow = 0.2;  // of a line's gain, by which its alias order exceeds that of a slow rotation
constexpr std::size_t kPeaks = 2;
constexpr double kMirrorReadout_frames = 0.2;    // smallest with which rows distinguish a band from its mirror image
constexpr double kTellingReadout_frames = 0.05;  // smallest with which rows distinguish a line from a slow rotation
constexpr double kPeakApart_hz = 1.0, kPeakWidth_hz = 0.3;

using Block = Eigen::Matrix2cd;

// P P^H.
Eigen::MatrixXcd moments_of(const Eigen::MatrixXcd& p) {
  const Eigen::MatrixXd re = p.real(), im = p.imag();
  const Eigen::MatrixXd even = gram(re) + gram(im);
  Eigen::MatrixXd odd = Eigen::MatrixXd::Zero(p.rows(), p.rows());
  add_product_transposed(odd, 1.0, im, re);
  Eigen::MatrixXcd out(p.rows(), p.rows());
  out.real() = even, out.imag() = odd - odd.transpose();
  return out;
}

double squares(const Block& hat, const Block& moments) {
  const Block freedom = Block::Identity() - hat;
  if (std::abs(freedom.determinant()) < 1e-4) return 0.0;
  const Block m = freedom.inverse();
  return (m * moments * m.adjoint()).trace().real();
}

// Orthonormal columns with the same span; dependent columns are dropped.
Eigen::MatrixXcd orthonormal(const Eigen::MatrixXcd& columns, const Eigen::VectorXd& norms) {
  Eigen::MatrixXcd q(columns.rows(), 0);
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::VectorXcd v = columns.col(c);
    for (int twice = 0; twice < 2; ++twice) v -= q * (q.adjoint() * v);
    if (!(v.norm() > 1e-3 * norms(c))) continue;
    q.conservativeResize(Eigen::NoChange, q.cols() + 1);
    q.col(q.cols() - 1) = v.normalized();
  }
  return q;
}

}  // namespace

LineSearch::LineSearch(const PointMotionModel& model, double rate_hz, double readout_frames, Eigen::MatrixXd fields,
                       Eigen::Index n_frames)
    : model_(model),
      rate_hz_(rate_hz),
      readout_frames_(readout_frames),
      fields_(std::move(fields)),
      n_frames_(n_frames),
      n_fft_(next_power_of_two(static_cast<int>(n_frames))) {}

Eigen::MatrixXcd LineSearch::spectrum(const Eigen::MatrixXd& residual) const {
  return row_spectra(residual, n_fft_, std::sqrt(2.0 / n_fft_));  // the one-sided spectrum holds all squares
}

LineSearch::Band LineSearch::band(double centre_hz, double half_width_hz) const {
  const double bin_hz = rate_hz_ / n_fft_;
  const auto low = static_cast<Eigen::Index>(std::ceil(std::max(centre_hz - half_width_hz, 0.5) / bin_hz));
  const auto high =
      static_cast<Eigen::Index>(std::floor(std::min(centre_hz + half_width_hz, 0.5 * rate_hz_ - bin_hz) / bin_hz));
  return {low, std::max<Eigen::Index>(high - low + 1, 0)};
}

std::vector<LineSearch::Side> LineSearch::sides(const LineFinding& finding) const {
  std::vector<Side> out{{finding.fold, finding.apparent_hz, band(finding.apparent_hz, finding.half_width_hz)}};
  const double mirrored_hz = rate_hz_ - finding.apparent_hz;
  if (std::abs(readout_frames_) < kMirrorReadout_frames) return out;
  const Band mirror = band(mirrored_hz, finding.half_width_hz);
  if (mirror.count > 0) out.push_back({-(finding.fold + 1), mirrored_hz, mirror});
  return out;
}

std::vector<double> LineSearch::peaks(const Eigen::MatrixXcd& spectrum, double from_hz, double to_hz) const {
  const Eigen::VectorXd power = spectrum.colwise().squaredNorm().transpose();
  const double bin_hz = rate_hz_ / n_fft_;
  std::vector<std::pair<double, double>> found;  // power, Hz
  const int n_places = static_cast<int>(std::ceil((to_hz - from_hz) / (0.25 * kPeakWidth_hz)));
  for (int place = 0; place < n_places; ++place) {
    const double f = from_hz + 0.25 * kPeakWidth_hz * place;
    const Band b = band(f, 0.5 * kPeakWidth_hz);
    if (b.count > 0) found.emplace_back(power.segment(b.first, b.count).mean(), f);
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<double> out;
  for (const auto& [_, f] : found) {
    const bool apart =
        std::all_of(out.begin(), out.end(), [peak = f](double o) { return std::abs(o - peak) > kPeakApart_hz; });
    if (apart) out.push_back(std::round(f / bin_hz) * bin_hz);
    if (out.size() == kPeaks) break;
  }
  return out;
}

Eigen::MatrixXcd LineSearch::fields_of(int fold) const {
  Eigen::MatrixXcd fields = fields_.cast<std::complex<double>>();
  const double turns = fold * readout_frames_;
  for (Eigen::Index j = 0; j < fields.rows() / 2; ++j)
    fields.middleRows(2 * j, 2) *= std::polar(1.0, 2.0 * std::numbers::pi * turns * model_.geometry().share(j));
  return fields;
}

Eigen::MatrixXcd LineSearch::fields_at(Eigen::Index bin, const std::vector<Side>& sides) const {
  Eigen::MatrixXcd fields(fields_.rows(), 0);
  for (const Side& side : sides) {
    if (!side.band.holds(bin)) continue;
    fields.conservativeResize(Eigen::NoChange, fields.cols() + fields_.cols());
    fields.rightCols(fields_.cols()) = fields_of(side.fold);
  }
  return fields;
}

Eigen::MatrixXcd LineSearch::left_of(const Eigen::MatrixXcd& fields, double hz) const {
  return model_.left_at(hz, model_.whitened(fields));
}

Eigen::MatrixXcd LineSearch::columns_of(int fold, double hz) const {
  const Eigen::MatrixXcd whitened = model_.whitened(fields_of(fold));
  return orthonormal(model_.left_at(hz, whitened), whitened.colwise().norm());
}

// g: orthonormal, outside the model's own columns.
double LineSearch::gain_of_columns(const Eigen::MatrixXcd& moments, const Eigen::MatrixXcd& g) const {
  const Eigen::MatrixXcd sg = moments * g, gsg = g.adjoint() * sg;
  double drop = 0.0;
  for (Eigen::Index i = 0; i < g.rows(); i += 2) {
    const auto q = model_.q_high().middleRows(i, 2);
    const Block hat = (q * q.transpose()).cast<std::complex<double>>();
    const Eigen::MatrixXcd gj = g.middleRows(i, 2), sj = sg.middleRows(i, 2);
    const Block before = moments.block<2, 2>(i, i);
    const Block after = before - gj * sj.adjoint() - sj * gj.adjoint() + gj * gsg * gj.adjoint();
    drop += squares(hat, before) - squares(hat + gj * gj.adjoint(), after);
  }
  return drop;
}

double LineSearch::pattern_gain(const Eigen::MatrixXcd& spectrum, const LineFinding& finding) const {
  constexpr Eigen::Index kParts = 5;
  constexpr int kSteps = 40;
  const Band b = band(finding.apparent_hz, finding.half_width_hz);
  const auto bins = spectrum.middleCols(b.first, b.count);
  std::vector<Eigen::MatrixXcd> parts;
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(bins.rows(), bins.rows());
  for (Eigen::Index p = 0; p < kParts; ++p) {
    // Every fifth bin: each part then contains bins of a narrow peak.
    Eigen::MatrixXcd part(bins.rows(), (b.count - p + kParts - 1) / kParts);
    for (Eigen::Index c = 0; c < part.cols(); ++c) part.col(c) = bins.col(p + c * kParts);
    parts.push_back(moments_of(part));
    sum += parts.back();
  }
  double gained = 0.0;
  for (const Eigen::MatrixXcd& part : parts) {
    const Eigen::MatrixXcd others = sum - part;
    Eigen::Index start = 0;
    others.diagonal().real().maxCoeff(&start);
    Eigen::VectorXcd v = others.col(start);
    for (int step = 0; step < kSteps && v.norm() > 0.0; ++step) v = (others * v.normalized()).eval();
    if (v.norm() > 0.0) gained += gain_of_columns(part, v.normalized());
  }
  return gained;
}

// Excludes the mirror image: a line must reach the threshold without it.
double LineSearch::band_gain(const Eigen::MatrixXcd& spectrum, const LineFinding& finding) const {
  const Band b = band(finding.apparent_hz, finding.half_width_hz);
  return b.count < 1 ? 0.0
                     : gain_of_columns(moments_of(spectrum.middleCols(b.first, b.count)),
                                       columns_of(finding.fold, finding.apparent_hz));
}

std::array<double, 3> LineSearch::quantiles_hz(const Eigen::MatrixXcd& spectrum, const LineFinding& finding) const {
  const Band b = band(finding.apparent_hz, finding.half_width_hz);
  const Eigen::MatrixXcd g = columns_of(finding.fold, finding.apparent_hz);
  const Eigen::MatrixXcd seen = g.adjoint() * spectrum.middleCols(b.first, b.count);
  const double noise = 2.0 * static_cast<double>(g.cols() * n_frames_) / n_fft_;
  const Eigen::VectorXd excess = seen.colwise().squaredNorm().transpose().array() - noise;
  std::array<double, 3> out{};
  const auto at = power_quantiles(excess, kSpreadShares);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = rate_hz_ / n_fft_ * static_cast<double>(b.first + at[i]);
  return out;
}

// Centres the finding at the median of its power, selects the half width of largest gain and computes its spread.
void LineSearch::recentre(const Eigen::MatrixXcd& spectrum, LineFinding& finding) const {
  if (!(finding.gain > 0.0)) return;
  const double margin = finding.gain - finding.next_gain;
  finding.apparent_hz = quantiles_hz(spectrum, finding)[1];
  finding.gain = -1e300;
  LineFinding trial = finding;
  for (const double half_width_hz : kHalfWidth_hz) {
    trial.half_width_hz = half_width_hz;
    trial.gain = band_gain(spectrum, trial);
    if (trial.gain > finding.gain) finding = trial;
  }
  finding.next_gain = finding.gain - margin;
  const std::array<double, 3> places = quantiles_hz(spectrum, finding);
  finding.spread_hz = 0.5 * (places[2] - places[0]);
}

void LineSearch::try_folds(const Eigen::MatrixXcd& spectrum, double apparent_hz, LineFinding& best) const {
  const int most = readout_frames_ == 0.0 ? 0 : kMostFolds;
  const Band middle = band(apparent_hz, kFoldWidth_hz);
  if (middle.count < 1) return;
  const Eigen::MatrixXcd moments = moments_of(spectrum.middleCols(middle.first, middle.count));
  LineFinding own;
  own.apparent_hz = apparent_hz;
  own.gain = own.next_gain = -1e300;
  double at_rest = 0.0;
  for (int fold = -most; fold <= most; ++fold) {
    const double g = gain_of_columns(moments, columns_of(fold, apparent_hz));
    if (fold == 0) at_rest = g;
    if (g > own.gain) {
      own.next_gain = own.gain, own.gain = g, own.fold = fold;
    } else {
      own.next_gain = std::max(own.next_gain, g);
    }
  }
  const double margin = own.gain - own.next_gain;
  if (best.apparent_hz > 0.0 && !(own.gain > 0.0)) return;
  const bool is_slow = apparent_hz < kSlowest_hz;
  if (is_slow && (own.fold == 0 || own.gain - at_rest < kLeastOverSlow * own.gain)) return;
  LineFinding trial = own;
  own.gain = -1e300;
  for (const double half_width_hz : kHalfWidth_hz) {
    trial.half_width_hz = half_width_hz;
    trial.gain = band_gain(spectrum, trial);
    if (trial.gain > own.gain) own = trial;
  }
  own.next_gain = own.gain - margin;
  if (best.apparent_hz == 0.0 || own.gain > best.gain) best = own;
}

LineFinding LineSearch::find(const Eigen::MatrixXcd& spectrum) const {
  LineFinding best;
  const double highest_hz = 0.5 * rate_hz_ - kPeakWidth_hz;
  for (const double peak : peaks(spectrum, kSlowest_hz, highest_hz)) try_folds(spectrum, peak, best);
  // Below, only the rows distinguish a line from the camera's slow rotations.
  if (std::abs(readout_frames_) >= kTellingReadout_frames) {
    for (const double peak : peaks(spectrum, kSlowestFolded_hz, kSlowest_hz)) try_folds(spectrum, peak, best);
  }
  recentre(spectrum, best);
  return best;
}

}  // namespace core::closure
