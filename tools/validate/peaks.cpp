#include "tools/validate/peaks.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/simulation/presets.h"
#include "core/simulation/structure/structure_response.h"
#include "core/types/constants.h"
#include "tools/validate/peak_fit.h"

namespace tools {
namespace {

using core::kTwoPi;
using core::simulation::Scene;
using core::simulation::StructureResponse;
using core::simulation::TrueMode;

// Rows: modes; columns: samples of the record.
Eigen::MatrixXd modal_coordinates(const StructureResponse& response, const Eigen::MatrixXd& shapes, double rate_hz,
                                  Eigen::Index n_samples) {
  Eigen::MatrixXd relative(shapes.rows(), n_samples);
  for (Eigen::Index k = 0; k < n_samples; ++k) {
    const double t_s = static_cast<double>(k) / rate_hz;
    const double ground_mm = response.displacement_mm(0, t_s);
    for (Eigen::Index i = 0; i < shapes.rows(); ++i) {
      relative(i, k) = response.displacement_mm(static_cast<int>(i) + 1, t_s) - ground_mm;
    }
  }
  return shapes.colPivHouseholderQr().solve(relative);
}

// A power of two less one, so that the padded transform is fast; at least 2.5 samples per period of the band's end.
Eigen::Index sample_count(const Scene& scene) {
  Eigen::Index n = 16;
  while (static_cast<double>(n) < 2.5 * scene.excitation.band_high_hz * scene.duration_s) n *= 2;
  return n - 1;
}

Eigen::MatrixXd shapes_of(const std::vector<TrueMode>& modes) {
  Eigen::MatrixXd shapes(modes.front().displacement.size(), static_cast<Eigen::Index>(modes.size()));
  for (std::size_t r = 0; r < modes.size(); ++r) {
    shapes.col(static_cast<Eigen::Index>(r)) = modes[r].displacement.real();
  }
  return shapes;
}

ModePeak declared_peak(const TrueMode& mode, double duration_s) {
  ModePeak peak;
  peak.frequency_hz = mode.frequency_hz;
  peak.damping_ratio = mode.damping_ratio;
  peak.frequency_scatter_hz =
      mode.frequency_hz * std::sqrt(mode.damping_ratio / (kTwoPi * mode.frequency_hz * duration_s));
  peak.damping_scatter = mode.damping_ratio / std::sqrt(kTwoPi * mode.damping_ratio * mode.frequency_hz * duration_s);
  return peak;
}

void add_error(PeakErrors& errors, double error) {  // sums until finish()
  errors.mean += error;
  errors.rms += error * error;
  if (std::abs(error) > std::abs(errors.worst)) errors.worst = error;
}

void finish(PeakErrors& errors, int n) {
  errors.mean /= n;
  errors.rms = std::sqrt(errors.rms / n);
}

// First with few tapers, then with the number that the width of the peak permits.
PeakFit fit_record(const std::vector<double>& record, double rate_hz, const Scene& scene) {
  int n_tapers = 4;
  PeakFit fit;
  for (int round = 0; round < 2; ++round) {
    // Keeps a distance from the ends of the input's band, by the width of the tapers' kernel.
    const double margin_hz = 2.0 * n_tapers / scene.duration_s;
    fit = fit_peak(TaperedSpectrum(record, rate_hz, n_tapers), scene.excitation.band_low_hz + margin_hz,
                   scene.excitation.band_high_hz - margin_hz);
    n_tapers = taper_count(fit.damping_ratio * fit.frequency_hz, scene.duration_s);
  }
  return fit;
}

void add_seed(PeakCheck& check, Scene scene, const Eigen::MatrixXd& shapes, std::uint64_t seed) {
  scene.seed = seed;
  const Eigen::Index n = sample_count(scene);
  const double rate_hz = static_cast<double>(n + 1) / scene.duration_s;
  const Eigen::MatrixXd coordinates = modal_coordinates(StructureResponse(scene), shapes, rate_hz, n);
  for (std::size_t r = 0; r < check.modes.size(); ++r) {
    const Eigen::VectorXd own = coordinates.row(static_cast<Eigen::Index>(r));
    const PeakFit fit = fit_record(std::vector<double>(own.begin(), own.end()), rate_hz, scene);
    ModePeak& mode = check.modes[r];
    if (!fit.converged) {
      ++mode.n_failed;
      continue;
    }
    add_error(mode.frequency, (fit.frequency_hz - mode.frequency_hz) / mode.frequency_scatter_hz);
    add_error(mode.damping, (fit.damping_ratio - mode.damping_ratio) / mode.damping_scatter);
  }
}

void set_bars(PeakCheck& check) {
  const double n = check.n_seeds, spread = 2.0 / (9.0 * n);
  constexpr double kNormal999 = 3.29;
  const auto chi = [&](double z) {
    return std::sqrt(std::pow(std::max(0.0, 1.0 - spread + z * std::sqrt(spread)), 3.0));
  };
  check.most_mean = 3.0 / std::sqrt(n);
  check.least_rms = chi(-kNormal999);
  check.most_rms = chi(kNormal999);
}

}  // namespace

bool PeakCheck::passed() const {
  const auto within = [&](const PeakErrors& e) {
    return std::abs(e.mean) <= most_mean && e.rms >= least_rms && e.rms <= most_rms;
  };
  return std::all_of(modes.begin(), modes.end(), [&](const ModePeak& mode) {
    return mode.n_failed == 0 && within(mode.frequency) && within(mode.damping);
  });
}

PeakCheck check_peaks(const Scene& scene, const core::simulation::StructureModel& declared, int n_seeds,
                      int first_seed) {
  const std::vector<TrueMode> modes = modes_of(declared);
  if (n_seeds < 1) throw std::invalid_argument("number of seeds is " + std::to_string(n_seeds) + "; give 1 or more");
  if (modes.empty() || modes.front().displacement.size() < static_cast<Eigen::Index>(modes.size())) {
    throw std::invalid_argument("the structure has more modes than bodies; give one whose bodies tell its modes apart");
  }
  const double least_s = 8.0 / (modes.front().damping_ratio * modes.front().frequency_hz);
  if (!(scene.duration_s >= least_s)) {
    throw std::invalid_argument("duration is " + std::to_string(scene.duration_s) + " s; give at least " +
                                std::to_string(least_s) + " s, or the lowest peak is too blurred to be judged");
  }
  PeakCheck check;
  check.n_seeds = n_seeds;
  check.duration_s = scene.duration_s;
  for (const TrueMode& mode : modes) check.modes.push_back(declared_peak(mode, scene.duration_s));
  const Eigen::MatrixXd shapes = shapes_of(modes);
  for (int i = 0; i < n_seeds; ++i) add_seed(check, scene, shapes, static_cast<std::uint64_t>(first_seed + i));
  for (ModePeak& mode : check.modes) {
    const int n = std::max(1, n_seeds - mode.n_failed);
    finish(mode.frequency, n);
    finish(mode.damping, n);
  }
  set_bars(check);
  return check;
}

PeakCheck check_peaks(int n_seeds, double duration_s, int first_seed) {
  const Scene scene = core::simulation::make_paper_scene(1, duration_s);
  return check_peaks(scene, scene.structure, n_seeds, first_seed);
}

}  // namespace tools
