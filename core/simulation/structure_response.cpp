#include "core/simulation/structure_response.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

using Complex = std::complex<double>;
constexpr double kTimeConstants = 12.0;
constexpr double kShortestScaling_s = 10.0;  // the rms of a shorter clip says more about its phase than about its level

double record_period_s(const StructureParameters& structure, double duration_s) {
  double slowest_1_s = std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < structure.frequency_hz.size(); ++r) {
    slowest_1_s =
        std::min(slowest_1_s, 2.0 * std::numbers::pi * structure.frequency_hz[r] * structure.damping_ratio[r]);
  }
  return std::max(1.5 * duration_s, duration_s + kTimeConstants / slowest_1_s);
}

// Base acceleration of density 1 (per Hz, one-sided), bins 0 .. n; zero outside the band.
std::vector<Complex> unit_acceleration(const StructureParameters& structure, std::uint64_t seed, double bin_hz) {
  RandomStream stream(seed, "base_acceleration");
  std::vector<Complex> amplitude(static_cast<std::size_t>(structure.band_high_hz / bin_hz) + 1);
  for (std::size_t k = 1; k < amplitude.size(); ++k) {
    if (static_cast<double>(k) * bin_hz < structure.band_low_hz) continue;
    const double re = stream.gaussian();
    amplitude[k] = std::sqrt(bin_hz) * Complex(re, stream.gaussian());
  }
  return amplitude;
}

// Columns: relative displacement of each floor for unit base acceleration at angular frequency w.
Eigen::VectorXcd relative_response(const StructureParameters& structure, const Eigen::MatrixXd& shapes, double w) {
  Eigen::VectorXcd floors = Eigen::VectorXcd::Zero(shapes.rows());
  for (Eigen::Index r = 0; r < shapes.cols(); ++r) {
    const double wr = 2.0 * std::numbers::pi * structure.frequency_hz[static_cast<std::size_t>(r)];
    const double zeta = structure.damping_ratio[static_cast<std::size_t>(r)];
    const double participation = shapes.col(r).sum() / shapes.col(r).squaredNorm();  // uniform masses
    floors += shapes.col(r) * (-participation / Complex(wr * wr - w * w, 2.0 * zeta * wr * w));
  }
  return floors;
}

}  // namespace

Eigen::MatrixXd shear_chain_shapes(int n_floors) {
  Eigen::MatrixXd shapes(n_floors, n_floors);
  for (int r = 1; r <= n_floors; ++r) {
    for (int i = 1; i <= n_floors; ++i) {
      shapes(i - 1, r - 1) = std::sin((2 * r - 1) * i * std::numbers::pi / (2 * n_floors + 1));
    }
    Eigen::Index largest = 0;
    shapes.col(r - 1).cwiseAbs().maxCoeff(&largest);
    const double scale = shapes(largest, r - 1);
    shapes.col(r - 1) /= scale;
  }
  return shapes;
}

StructureResponse::StructureResponse(const StructureParameters& structure, std::uint64_t seed, double duration_s,
                                     double grid_rate_hz)
    : duration_s_(duration_s), displacement_(static_cast<std::size_t>(structure.n_floors()) + 1) {
  if (structure.roof_rms_mm <= 0.0) return;
  const double period_s = record_period_s(structure, duration_s);
  const std::size_t n_grid = grid_size(period_s, std::max(grid_rate_hz, 10.0 * structure.band_high_hz));
  const std::vector<Complex> acceleration = unit_acceleration(structure, seed, 1.0 / period_s);
  const Eigen::MatrixXd shapes = shear_chain_shapes(structure.n_floors());

  std::vector<std::vector<Complex>> absolute(displacement_.size(), std::vector<Complex>(acceleration.size()));
  std::vector<Complex> roof(acceleration.size());
  for (std::size_t k = 1; k < acceleration.size(); ++k) {
    if (acceleration[k] == 0.0) continue;
    const double w = 2.0 * std::numbers::pi * static_cast<double>(k) / period_s;
    const Eigen::VectorXcd relative = relative_response(structure, shapes, w) * acceleration[k];
    absolute[0][k] = -acceleration[k] / (w * w);
    for (std::size_t i = 1; i < absolute.size(); ++i) {
      absolute[i][k] = absolute[0][k] + relative[static_cast<Eigen::Index>(i) - 1];
    }
    roof[k] = relative[relative.size() - 1];
  }
  const PeriodicSignal roof_relative(roof, period_s, n_grid);
  const double factor = structure.roof_rms_mm / roof_relative.rms(0.0, std::max(duration_s, kShortestScaling_s));
  for (std::size_t i = 0; i < absolute.size(); ++i) {
    displacement_[i] = PeriodicSignal(absolute[i], period_s, n_grid);
    displacement_[i].multiply(factor);
  }
  base_acceleration_rms_ = factor * PeriodicSignal(acceleration, period_s, n_grid).rms(0.0, duration_s);
  roof_relative_rms_ = factor * roof_relative.rms(0.0, duration_s);
}

double StructureResponse::displacement_mm(int body, double t_s) const noexcept {
  return displacement_[static_cast<std::size_t>(body)].at(t_s);
}

double StructureResponse::rms_mm(int body) const noexcept {
  return displacement_[static_cast<std::size_t>(body)].rms(0.0, duration_s_);
}

double StructureResponse::roof_relative_rms_mm() const noexcept { return roof_relative_rms_; }

}  // namespace core::simulation
