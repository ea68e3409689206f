#include "core/simulation/structure/structure_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/simulation/random_stream.h"
#include "core/simulation/structure/changing_stiffness.h"
#include "core/simulation/structure/modal_form.h"
#include "core/types/constants.h"

namespace core::simulation {
namespace {

using Complex = std::complex<double>;
using Spectrum = std::vector<Complex>;
constexpr double kTimeConstants = 12.0;
constexpr double kShortestScaling_s = 10.0;  // in a shorter clip the rms depends on the phase more than on the level

// Poles far above the band respond quasi-statically: their decay is invisible, however slow it is.
double record_period_s(const StructureModel& model, const ExcitationParameters& excitation, double duration_s) {
  double slowest_1_s = std::numeric_limits<double>::infinity();
  for (const Complex& pole : poles_of(modal_form(model.mass, model.damping, model.stiffness)).s) {
    if (std::abs(pole) <= 2.0 * kTwoPi * excitation.band_high_hz) slowest_1_s = std::min(slowest_1_s, -pole.real());
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

// Ground's acceleration and forces by bin; empty = none.
struct Input {
  Spectrum acceleration;
  std::vector<Spectrum> force;  // by body from 1
};

// Both of density 1.
Input draw_input(const ExcitationParameters& excitation, int n_bodies, std::uint64_t seed, double bin_hz) {
  Input input;
  if (excitation.base > 0.0) {
    input.acceleration = white_band(excitation, bin_hz, RandomStream(seed, "base_acceleration"));
  }
  for (int body = 1; excitation.forces > 0.0 && body <= n_bodies; ++body) {
    input.force.push_back(
        white_band(excitation, bin_hz, RandomStream(seed, "body_force", static_cast<std::uint64_t>(body))));
  }
  return input;
}

// Transfer function from the input to the visible bodies, by modes: as exact as response_at, and many times faster.
class Transfer {
 public:
  explicit Transfer(const StructureModel& model)
      : form_(modal_form(model.mass, model.damping, model.stiffness)),
        displacement_(model.displacement * form_.shapes),
        tilt_(model.tilt * form_.shapes),
        influence_(form_.shapes.transpose() * model.influence) {}

  [[nodiscard]] Eigen::VectorXcd modes_at(double w, const Input& input, std::size_t k) const {
    return modal_response(form_, w, load_at(input, k));
  }
  [[nodiscard]] Eigen::VectorXcd load_at(const Input& input, std::size_t k) const {
    Eigen::VectorXcd load = Eigen::VectorXcd::Zero(influence_.size());
    if (!input.acceleration.empty()) load -= input.acceleration[k] * influence_;
    for (std::size_t i = 0; i < input.force.size(); ++i)
      load += input.force[i][k] * displacement_.row(static_cast<Eigen::Index>(i)).transpose();
    return load;
  }
  [[nodiscard]] const ModalForm& form() const noexcept { return form_; }
  [[nodiscard]] const Eigen::MatrixXd& displacement() const noexcept { return displacement_; }  // bodies x modes
  [[nodiscard]] const Eigen::MatrixXd& tilt() const noexcept { return tilt_; }

 private:
  ModalForm form_;
  Eigen::MatrixXd displacement_, tilt_;
  Eigen::VectorXd influence_;
};

// Bins of the record inside the band.
struct Bins {
  double period_s;
  std::size_t first, end;
  [[nodiscard]] double w(std::size_t k) const noexcept { return kTwoPi * static_cast<double>(k) / period_s; }
};

// Rms of the last body relative to the ground, over the clip.
double roof_rms(const Transfer& transfer, const Input& input, const Bins& bins, std::size_t n_grid, double clip_s) {
  Spectrum roof(bins.end);
  const auto row = transfer.displacement().row(transfer.displacement().rows() - 1).eval();
  for (std::size_t k = bins.first; k < bins.end; ++k) {
    roof[k] = (row * transfer.modes_at(bins.w(k), input, k))(0);
  }
  return PeriodicSignal(roof, bins.period_s, n_grid).rms(0.0, std::max(clip_s, kShortestScaling_s));
}

double scale(const char* what, double wanted_mm, double unit_mm) {
  if (unit_mm > 0.0) return wanted_mm / unit_mm;
  throw std::invalid_argument(std::string("simulation: ") + what +
                              " does not move the last body, whose displacement rms_mm sets: give it the weight 0");
}

void multiply(Spectrum& spectrum, double factor) {
  for (Complex& value : spectrum) value *= factor;
}

// Ground and forces are scaled to their levels separately, the ground before its colour, so that neither depends on
// presence or level of the others.
void bring_to_level(Input& input, const ExcitationParameters& excitation, const Transfer& transfer, const Bins& bins,
                    std::size_t n_grid, double clip_s) {
  if (!input.acceleration.empty()) {
    const double unit_mm = roof_rms(transfer, {input.acceleration, {}}, bins, n_grid, clip_s);
    multiply(input.acceleration, scale("the ground's motion", excitation.base * excitation.rms_mm, unit_mm));
    for (std::size_t k = bins.first; k < bins.end; ++k) {
      input.acceleration[k] *= colour(excitation, static_cast<double>(k) / bins.period_s);
    }
  }
  if (input.force.empty()) return;
  const double unit_mm = roof_rms(transfer, {{}, input.force}, bins, n_grid, clip_s);
  const double factor = scale("the forces", excitation.forces * excitation.rms_mm, unit_mm);
  for (Spectrum& force : input.force) multiply(force, factor);
}

// Relative displacement (or tilt) of every body with changing stiffness, under the same input.
Eigen::MatrixXd integrated(const Transfer& transfer, const Input& input, const Bins& bins, std::size_t n_grid,
                           double roof_rms_mm, double duration_s, double rate_hz, const ChangeParameters& change) {
  const auto n_modes = static_cast<std::size_t>(transfer.form().w.size());
  std::vector<Spectrum> force(n_modes, Spectrum(bins.end)), place = force, speed = force;
  for (std::size_t k = bins.first; k < bins.end; ++k) {
    const Eigen::VectorXcd load = transfer.load_at(input, k), z = transfer.modes_at(bins.w(k), input, k);
    for (std::size_t r = 0; r < n_modes; ++r) {
      const auto i = static_cast<Eigen::Index>(r);
      force[r][k] = load(i), place[r][k] = z(i), speed[r][k] = Complex(0.0, bins.w(k)) * z(i);
    }
  }
  ChangingInput changing;
  changing.form = &transfer.form();
  changing.position.resize(static_cast<Eigen::Index>(n_modes));
  changing.velocity.resize(static_cast<Eigen::Index>(n_modes));
  for (std::size_t r = 0; r < n_modes; ++r) {
    const auto i = static_cast<Eigen::Index>(r);
    changing.force.emplace_back(force[r], bins.period_s, n_grid);
    changing.position(i) = PeriodicSignal(place[r], bins.period_s, n_grid).at(0.0);
    changing.velocity(i) = PeriodicSignal(speed[r], bins.period_s, n_grid).at(0.0);
  }
  changing.roof = transfer.displacement().row(transfer.displacement().rows() - 1);
  changing.roof_rms_mm = roof_rms_mm;
  changing.duration_s = duration_s;
  changing.rate_hz = rate_hz;
  return integrate_changing(changing, change);
}

std::vector<UniformSpline> splines(const Eigen::MatrixXd& modes, const Eigen::MatrixXd& per_mode, double rate_hz) {
  std::vector<UniformSpline> out;
  for (Eigen::Index body = 0; body < per_mode.rows(); ++body) {
    const Eigen::VectorXd samples = modes * per_mode.row(body).transpose();
    out.emplace_back(std::vector<double>(samples.begin(), samples.end()), rate_hz);
  }
  return out;
}

}  // namespace

StructureResponse::StructureResponse(const Scene& scene, double grid_rate_hz)
    : StructureResponse(scene.structure, scene.excitation, scene.seed, scene.duration_s, grid_rate_hz, scene.change) {}

StructureResponse::StructureResponse(const StructureModel& model, const ExcitationParameters& excitation,
                                     std::uint64_t seed, double duration_s, double grid_rate_hz,
                                     const ChangeParameters& change)
    : duration_s_(duration_s),
      tilts_(model.tilt.cwiseAbs().maxCoeff() > 0.0),
      displacement_(static_cast<std::size_t>(model.n_bodies()) + 1),
      tilt_(displacement_.size()) {
  if (excitation.rms_mm > 0.0 && (excitation.base > 0.0 || excitation.forces > 0.0)) {
    add_broadband(model, excitation, seed, grid_rate_hz, change);
  }
  for (std::size_t i = 0; i < excitation.harmonics.size(); ++i) {
    RandomStream phase(seed, "harmonic_phase", i);
    add_line(model, excitation.harmonics[i], kTwoPi * phase.uniform());
  }
}

void StructureResponse::add_broadband(const StructureModel& model, const ExcitationParameters& excitation,
                                      std::uint64_t seed, double grid_rate_hz, const ChangeParameters& change) {
  const double period_s = record_period_s(model, excitation, duration_s_);
  const std::size_t n_grid = grid_size(period_s, std::max(grid_rate_hz, 10.0 * excitation.band_high_hz));
  const Bins bins{period_s, static_cast<std::size_t>(std::ceil(excitation.band_low_hz * period_s)),
                  static_cast<std::size_t>(excitation.band_high_hz * period_s) + 1};
  const Transfer transfer(model);
  Input input = draw_input(excitation, model.n_bodies(), seed, 1.0 / period_s);
  bring_to_level(input, excitation, transfer, bins, n_grid, duration_s_);

  std::vector<Spectrum> absolute(displacement_.size(), Spectrum(bins.end)),
      tilt(tilts_ ? tilt_.size() : 0, absolute[0]);
  Eigen::VectorXcd relative, turned;
  for (std::size_t k = bins.first; k < bins.end; ++k) {
    const Eigen::VectorXcd modes = transfer.modes_at(bins.w(k), input, k);
    relative.noalias() = transfer.displacement() * modes;
    if (!input.acceleration.empty()) absolute[0][k] = -input.acceleration[k] / (bins.w(k) * bins.w(k));
    if (tilts_) turned.noalias() = transfer.tilt() * modes;
    for (std::size_t i = 1; i < absolute.size(); ++i) {
      absolute[i][k] = absolute[0][k] + relative[static_cast<Eigen::Index>(i) - 1];
      if (tilts_) tilt[i][k] = turned[static_cast<Eigen::Index>(i) - 1];
    }
  }
  for (std::size_t i = 0; i < absolute.size(); ++i) {
    displacement_[i] = PeriodicSignal(absolute[i], period_s, n_grid);
    if (tilts_ && i > 0) tilt_[i] = PeriodicSignal(tilt[i], period_s, n_grid);
  }
  Spectrum& roof = absolute.back();
  for (std::size_t k = bins.first; k < bins.end; ++k) roof[k] -= absolute[0][k];
  roof_relative_rms_ = PeriodicSignal(roof, period_s, n_grid).rms(0.0, duration_s_);
  if (change.frequency_drift != 0.0 || change.softening != 0.0) {
    const double rate_hz = std::max(grid_rate_hz, 10.0 * excitation.band_high_hz);
    const Eigen::MatrixXd modes =
        integrated(transfer, input, bins, n_grid, roof_relative_rms_, duration_s_, rate_hz, change);
    changed_ = splines(modes, transfer.displacement(), rate_hz);
    if (tilts_) changed_tilt_ = splines(modes, transfer.tilt(), rate_hz);
  }
  if (input.acceleration.empty()) return;
  base_acceleration_rms_ = PeriodicSignal(input.acceleration, period_s, n_grid).rms(0.0, duration_s_);
}

void StructureResponse::add_line(const StructureModel& model, const ExcitationParameters::Harmonic& harmonic,
                                 double phase_rad) {
  const double w = kTwoPi * harmonic.frequency_hz;
  const Eigen::VectorXcd force = model.displacement.row(harmonic.body - 1).transpose().cast<Complex>();
  const Eigen::VectorXcd q = response_at(model, w, force);
  const Eigen::VectorXcd moved = model.displacement * q, turned = model.tilt * q;
  const double own = std::abs(moved[harmonic.body - 1]);
  if (!(own > 0.0)) {
    throw std::invalid_argument("simulation: body " + std::to_string(harmonic.body) +
                                " does not move under a harmonic force on it; choose another body");
  }
  const Complex amplitude = std::polar(std::numbers::sqrt2 * harmonic.rms_mm / own, phase_rad);
  Line line{w, {Complex(0.0)}, {Complex(0.0)}};
  for (Eigen::Index i = 0; i < moved.size(); ++i) {
    line.displacement.push_back(amplitude * moved[i]);
    line.tilt.push_back(amplitude * turned[i]);
  }
  lines_.push_back(std::move(line));
}

double StructureResponse::displacement_mm(int body, double t_s) const noexcept {
  const auto i = static_cast<std::size_t>(body);
  double value =
      changed_.empty() || body == 0 ? displacement_[i].at(t_s) : displacement_[0].at(t_s) + changed_[i - 1].at(t_s);
  for (const Line& line : lines_) value += (line.displacement[i] * std::polar(1.0, line.w * t_s)).real();
  return value;
}

double StructureResponse::tilt_rad(int body, double t_s) const noexcept {
  if (!tilts_) return 0.0;
  const auto i = static_cast<std::size_t>(body);
  double value = changed_tilt_.empty() || body == 0 ? tilt_[i].at(t_s) : changed_tilt_[i - 1].at(t_s);
  for (const Line& line : lines_) value += (line.tilt[i] * std::polar(1.0, line.w * t_s)).real();
  return value;
}

double StructureResponse::rms_mm(int body) const noexcept {
  return displacement_[static_cast<std::size_t>(body)].rms(0.0, duration_s_);
}

double StructureResponse::roof_relative_rms_mm() const noexcept { return roof_relative_rms_; }

}  // namespace core::simulation
