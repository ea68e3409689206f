#include "core/simulation/structure_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

using Complex = std::complex<double>;
using Spectrum = std::vector<Complex>;
constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kTimeConstants = 12.0;
constexpr double kShortestScaling_s = 10.0;  // the rms of a shorter clip says more about its phase than about its level

double record_period_s(const StructureModel& model, double duration_s) {
  double slowest_1_s = std::numeric_limits<double>::infinity();
  for (const TrueMode& mode : modes_of(model)) {
    slowest_1_s = std::min(slowest_1_s, kTwoPi * mode.frequency_hz * mode.damping_ratio);
  }
  return std::max(1.5 * duration_s, duration_s + kTimeConstants / slowest_1_s);
}

// Density 1 (per Hz, one-sided) in the band, bins 0 .. n.
Spectrum white_band(const ExcitationParameters& excitation, double bin_hz, RandomStream stream) {
  Spectrum amplitude(static_cast<std::size_t>(excitation.band_high_hz / bin_hz) + 1);
  for (std::size_t k = 1; k < amplitude.size(); ++k) {
    if (static_cast<double>(k) * bin_hz < excitation.band_low_hz) continue;
    const double re = stream.gaussian();
    amplitude[k] = std::sqrt(bin_hz) * Complex(re, stream.gaussian());
  }
  return amplitude;
}

// 1 plus, at each peak, the resonance curve of an oscillator scaled to `gain` at its frequency.
Complex colour(const ExcitationParameters& excitation, double f) {
  Complex factor = 1.0;
  for (const auto& peak : excitation.base_peaks) {
    const double ratio = f / peak.frequency_hz, width = 2.0 * peak.damping_ratio;
    factor += peak.gain * Complex(0.0, width * ratio) / Complex(1.0 - ratio * ratio, width * ratio);
  }
  return factor;
}

// Base acceleration and forces by bin; empty = none.
struct Input {
  Spectrum acceleration;
  std::vector<Spectrum> force;  // by body from 1
};

Input draw_input(const ExcitationParameters& excitation, int n_bodies, std::uint64_t seed, double bin_hz) {
  Input input;
  input.acceleration = white_band(excitation, bin_hz, RandomStream(seed, "base_acceleration"));
  for (std::size_t k = 1; k < input.acceleration.size(); ++k) {
    input.acceleration[k] *= excitation.base * colour(excitation, static_cast<double>(k) * bin_hz);
  }
  if (excitation.forces <= 0.0) return input;
  for (int body = 1; body <= n_bodies; ++body) {
    input.force.push_back(
        white_band(excitation, bin_hz, RandomStream(seed, "body_force", static_cast<std::uint64_t>(body))));
    for (Complex& f : input.force.back()) f *= excitation.forces;
  }
  return input;
}

Eigen::VectorXcd force_at(const StructureModel& model, const Input& input, std::size_t k) {
  Eigen::VectorXcd force = -model.influence.cast<Complex>() * input.acceleration[k];
  for (std::size_t i = 0; i < input.force.size(); ++i) {
    force += model.displacement.row(static_cast<Eigen::Index>(i)).transpose().cast<Complex>() * input.force[i][k];
  }
  return force;
}

}  // namespace

StructureResponse::StructureResponse(const Scene& scene, double grid_rate_hz)
    : StructureResponse(scene.structure, scene.excitation, scene.seed, scene.duration_s, grid_rate_hz) {}

StructureResponse::StructureResponse(const StructureModel& model, const ExcitationParameters& excitation,
                                     std::uint64_t seed, double duration_s, double grid_rate_hz)
    : duration_s_(duration_s),
      tilts_(model.tilt.cwiseAbs().maxCoeff() > 0.0),
      displacement_(static_cast<std::size_t>(model.n_bodies()) + 1),
      tilt_(displacement_.size()) {
  if (excitation.rms_mm > 0.0 && (excitation.base > 0.0 || excitation.forces > 0.0)) {
    add_broadband(model, excitation, seed, grid_rate_hz);
  }
  for (std::size_t i = 0; i < excitation.harmonics.size(); ++i) {
    RandomStream phase(seed, "harmonic_phase", i);
    add_line(model, excitation.harmonics[i], kTwoPi * phase.uniform());
  }
}

void StructureResponse::add_broadband(const StructureModel& model, const ExcitationParameters& excitation,
                                      std::uint64_t seed, double grid_rate_hz) {
  const double period_s = record_period_s(model, duration_s_);
  const std::size_t n_grid = grid_size(period_s, std::max(grid_rate_hz, 10.0 * excitation.band_high_hz));
  const Input input = draw_input(excitation, model.n_bodies(), seed, 1.0 / period_s);
  const std::size_t n_bins = input.acceleration.size();

  std::vector<Spectrum> absolute(displacement_.size(), Spectrum(n_bins)),
      tilt(tilts_ ? displacement_.size() : 0, Spectrum(n_bins));
  Spectrum roof(n_bins);
  for (std::size_t k = 1; k < n_bins; ++k) {
    if (static_cast<double>(k) / period_s < excitation.band_low_hz) continue;
    const double w = kTwoPi * static_cast<double>(k) / period_s;
    const Eigen::VectorXcd q = response_at(model, w, force_at(model, input, k));
    const Eigen::VectorXcd relative = model.displacement * q;
    absolute[0][k] = -input.acceleration[k] / (w * w);
    for (std::size_t i = 1; i < absolute.size(); ++i) {
      absolute[i][k] = absolute[0][k] + relative[static_cast<Eigen::Index>(i) - 1];
    }
    roof[k] = relative[relative.size() - 1];
    if (!tilts_) continue;
    const Eigen::VectorXcd turned = model.tilt * q;
    for (std::size_t i = 1; i < tilt.size(); ++i) tilt[i][k] = turned[static_cast<Eigen::Index>(i) - 1];
  }
  const PeriodicSignal roof_relative(roof, period_s, n_grid);
  const double factor = excitation.rms_mm / roof_relative.rms(0.0, std::max(duration_s_, kShortestScaling_s));
  for (std::size_t i = 0; i < absolute.size(); ++i) {
    displacement_[i] = PeriodicSignal(absolute[i], period_s, n_grid);
    displacement_[i].multiply(factor);
    if (!tilts_ || i == 0) continue;
    tilt_[i] = PeriodicSignal(tilt[i], period_s, n_grid);
    tilt_[i].multiply(factor);
  }
  base_acceleration_rms_ = factor * PeriodicSignal(input.acceleration, period_s, n_grid).rms(0.0, duration_s_);
  roof_relative_rms_ = factor * roof_relative.rms(0.0, duration_s_);
}

void StructureResponse::add_line(const StructureModel& model, const ExcitationParameters::Harmonic& harmonic,
                                 double phase_rad) {
  const double w = kTwoPi * harmonic.frequency_hz;
  const Eigen::VectorXcd force = model.displacement.row(harmonic.body - 1).transpose().cast<Complex>();
  const Eigen::VectorXcd q = response_at(model, w, force);
  const Eigen::VectorXcd moved = model.displacement * q, turned = model.tilt * q;
  const double own = std::abs(moved[harmonic.body - 1]);
  const Complex scale = own > 0.0 ? std::polar(std::numbers::sqrt2 * harmonic.rms_mm / own, phase_rad) : Complex(0.0);
  Line line{w, {Complex(0.0)}, {Complex(0.0)}};
  for (Eigen::Index i = 0; i < moved.size(); ++i) {
    line.displacement.push_back(scale * moved[i]);
    line.tilt.push_back(scale * turned[i]);
  }
  lines_.push_back(std::move(line));
}

double StructureResponse::displacement_mm(int body, double t_s) const noexcept {
  const auto i = static_cast<std::size_t>(body);
  double value = displacement_[i].at(t_s);
  for (const Line& line : lines_) value += (line.displacement[i] * std::polar(1.0, line.w * t_s)).real();
  return value;
}

double StructureResponse::tilt_rad(int body, double t_s) const noexcept {
  if (!tilts_) return 0.0;
  const auto i = static_cast<std::size_t>(body);
  double value = tilt_[i].at(t_s);
  for (const Line& line : lines_) value += (line.tilt[i] * std::polar(1.0, line.w * t_s)).real();
  return value;
}

double StructureResponse::rms_mm(int body) const noexcept {
  return displacement_[static_cast<std::size_t>(body)].rms(0.0, duration_s_);
}

double StructureResponse::roof_relative_rms_mm() const noexcept { return roof_relative_rms_; }

}  // namespace core::simulation
