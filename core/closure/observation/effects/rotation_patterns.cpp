#include "core/closure/observation/effects/rotation_patterns.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "core/closure/observation/line_search.h"
#include "core/closure/observation/power_quantiles.h"
#include "core/spectrum/real_fft.h"

namespace core::closure {
namespace {

constexpr double kAboveDrift_hz = 1.0, kNarrow_hz = 1.2, kWidestVibration_hz = 2.0;
constexpr double kToldSigmas = 4.0;
constexpr double kLeastLever = 0.02;  // of the focal length, between the base and the optical axis

// One-sided spectrum that holds all squares of the series.
Eigen::RowVectorXcd one_sided_of(const Eigen::RowVectorXd& values) {
  RealFft fft(next_power_of_two(static_cast<int>(values.size())));
  std::vector<double> series(static_cast<std::size_t>(fft.size()), 0.0);
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(fft.n_bins()));
  for (Eigen::Index k = 0; k < values.size(); ++k) series[static_cast<std::size_t>(k)] = values(k) - values.mean();
  fft.forward(series, bins);
  Eigen::RowVectorXcd out(fft.n_bins());
  for (Eigen::Index b = 0; b < out.size(); ++b)
    out(b) = std::sqrt(2.0 / fft.size()) * bins[static_cast<std::size_t>(b)];
  return out;
}

// The base's displacement in the model: its series, the displacement per unit of a turn about the optical axis, and the
// time of its rows after the frames' common instant.
struct BaseMotion {
  Eigen::RowVectorXd series;
  double per_turn = 0.0, later_frames = 0.0;
};

std::optional<BaseMotion> base_motion(const FitView& fit, const Eigen::VectorXd& roll) {
  for (std::size_t r = 0; r < fit.record.regions.size(); ++r) {
    const Region& region = fit.record.regions[r];
    const Eigen::Index row = fit.model.row_of_region(2 * r);
    if (region.role != RegionRole::kBase || row < 0) continue;
    const double angle = region.both_axes ? 0.0 : region.axis_deg * std::numbers::pi / 180.0;
    double sum = 0.0, n = 0.0;
    for (std::size_t j = 0; j < fit.record.region_of_point.size(); ++j) {
      if (fit.record.region_of_point[j] != r) continue;
      const auto at = roll.segment<2>(2 * static_cast<Eigen::Index>(j));
      sum += std::cos(angle) * at(0) + std::sin(angle) * at(1), n += 1.0;
    }
    if (!(n > 0.0) || !(std::abs(sum) > kLeastLever * n * fit.record.alpha_px)) continue;
    const double later = fit.readout_frames * (fit.model.share_of_column(row) - PointMotionModel::kCommonShare);
    return BaseMotion{fit.model.amplitudes().row(row), sum / n, later};
  }
  return std::nullopt;
}

}  // namespace

Eigen::VectorXd roll_pattern(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j) out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(g.y(j), -g.x(j));
  return out;
}

Eigen::VectorXd pitch_pattern(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j)
    out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(g.x(j) * g.y(j), g.y(j) * g.y(j));
  return out;
}

Eigen::VectorXd yaw_pattern(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j)
    out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(-g.x(j) * g.x(j), -g.x(j) * g.y(j));
  return out;
}

Eigen::MatrixXd rotation_patterns(const PointGeometry& g, bool complete) {
  Eigen::MatrixXd out(2 * g.x.size(), 3);
  out << roll_pattern(g), pitch_pattern(g), yaw_pattern(g);
  if (!complete) return out;
  for (Eigen::Index j = 0; j < g.x.size(); ++j) out(2 * j + 1, 1) += g.alpha_px, out(2 * j, 2) -= g.alpha_px;
  return out;
}

bool has_background(const ObservationRecord& record) {
  return std::any_of(record.region_of_point.begin(), record.region_of_point.end(),
                     [&](std::size_t r) { return !makes_channel(record.regions[r].role); });
}

bool RollCourse::is_resonance() const noexcept {
  return low_hz > kAboveDrift_hz && 0.5 * (high_hz - low_hz) <= kNarrow_hz;
}
bool RollCourse::is_vibration() const noexcept {
  return low_hz > kAboveDrift_hz && 0.5 * (high_hz - low_hz) <= kWidestVibration_hz &&
         middle_hz > LineSearch::kSlowest_hz;
}
bool RollCourse::is_about_axis() const noexcept {
  return about_axis > kToldSigmas * sigma && std::abs(about_axis - 1.0) < 0.5;
}
bool RollCourse::is_about_base() const noexcept {
  return 1.0 - about_axis > kToldSigmas * sigma && std::abs(about_axis) < 0.5;
}

RollCourse roll_course(const FitView& fit, RungSet band) {
  const double infinite = std::numeric_limits<double>::infinity();
  RollCourse out{.sigma = infinite};
  const Eigen::VectorXd roll = roll_pattern(fit.model.geometry());
  const Eigen::VectorXd whitened = fit.model.whitened(roll);
  const Eigen::VectorXd beside = whitened - fit.model.q_low() * (fit.model.q_low().transpose() * whitened);
  if (!(beside.norm() > kLeastBeside * whitened.norm())) return out;
  const Eigen::RowVectorXcd turn = one_sided_of(beside.normalized().transpose() * fit.model.residual());
  const Rungs& rungs = fit.held_out.rungs();
  const double bin_hz = 0.5 * fit.record.rate_hz / static_cast<double>(turn.size() - 1);
  const double noise = static_cast<double>(fit.record.n_frames()) / static_cast<double>(turn.size() - 1);
  std::vector<Eigen::Index> bins;
  for (Eigen::Index b = 1; b < turn.size(); ++b) {
    if (band == kAllRungs || holds(band, rungs.of(bin_hz * static_cast<double>(b)))) bins.push_back(b);
  }
  const Eigen::VectorXd power = (turn(bins).cwiseAbs2().array() - noise).matrix().transpose();
  if (!(power.sum() > 0.0)) return out;
  const auto reached = power_quantiles(power, kSpreadShares);
  const auto hz_of = [&](Eigen::Index i) { return bin_hz * static_cast<double>(bins[static_cast<std::size_t>(i)]); };
  out.low_hz = hz_of(reached[0]), out.middle_hz = hz_of(reached[1]), out.high_hz = hz_of(reached[2]);
  const std::optional<BaseMotion> base = base_motion(fit, roll);
  if (!base) return out;
  // Regression of the base's displacement on the turn, over the bins between the outer quantiles.
  const Eigen::RowVectorXcd moved = one_sided_of(base->series);
  double own = 0.0, square = 0.0, cross = 0.0, n = 0.0;
  for (const Eigen::Index b : bins) {
    const double hz = bin_hz * static_cast<double>(b);
    if (hz < out.low_hz || hz > out.high_hz) continue;
    const double angle = -2.0 * std::numbers::pi * hz / fit.record.rate_hz * base->later_frames;
    cross += (moved(b) * std::polar(1.0, angle) * std::conj(turn(b))).real();
    own += std::norm(turn(b)), square += std::norm(moved(b)), n += 1.0;
  }
  const double signal = own - n * noise;
  if (!(signal > 0.0)) return out;
  const double scale = beside.norm() / base->per_turn;  // from the unit of the residual to that of the turn
  const double slope = cross / signal;
  // Neighbouring bins of the padded spectrum share noise.
  const double freedom = std::max(2.0 * n * noise / 2.0, 1.0);
  const double left = std::max(square - cross * cross / own, 0.0) / freedom;
  out.about_axis = scale * slope;
  out.sigma = std::abs(scale) * std::sqrt(left * own) / signal;
  return out;
}

std::string not_of_camera(const RollCourse& course, const FitView& fit) {
  if (has_background(fit.record) || !course.is_resonance() || course.is_about_axis()) return {};
  return course.is_about_base() ? "it turns about the structure's base and not about the optical axis"
                                : "a resonance, and without a background the structure's rocking cannot be "
                                  "distinguished from the camera's roll";
}

}  // namespace core::closure
