#include "tools/validate/lines_beside_modes.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/simulation/structure/structure_response.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/geometry_score.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/trust_scene.h"

namespace tools {
namespace {

using core::Mode;
using core::Verdict;
using core::simulation::Scene;
using core::simulation::TrueMode;

constexpr double kGrid_hz = 50.0;        // of the motion from which a mode's rms is taken
constexpr double kNearMachine = 0.004;   // relative: a pole of a machine's line
constexpr double kNearRotor_hz = 1.0;    // a pole of a rotor's line, which wanders: 3 sigma
constexpr double kSameMode = 0.01;       // relative: a pole of a mode
constexpr double kClear = 0.005;         // relative: least distance of a line from every mode
constexpr std::array kRatios{1.0, 0.3};  // rms of the line over that of the mode beside it

// Rms of every mode's part of the last body's motion, mm.
std::vector<double> modal_rms_mm(const Scene& scene, const std::vector<TrueMode>& modes) {
  const core::simulation::StructureResponse response(scene);
  const auto n = static_cast<Eigen::Index>(modes.size());
  Eigen::MatrixXd shapes(n, n);
  for (Eigen::Index r = 0; r < n; ++r) shapes.col(r) = modes[static_cast<std::size_t>(r)].displacement.real();
  const Eigen::MatrixXd to_modes = shapes.inverse();
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(n), motion(n);
  const auto n_samples = static_cast<int>(scene.duration_s * kGrid_hz);
  for (int k = 0; k < n_samples; ++k) {
    for (Eigen::Index body = 0; body < n; ++body) {
      const double t_s = k / kGrid_hz;
      motion[body] = response.displacement_mm(static_cast<int>(body) + 1, t_s) - response.displacement_mm(0, t_s);
    }
    squares += (to_modes * motion).cwiseAbs2();
  }
  std::vector<double> out;
  for (Eigen::Index r = 0; r < n; ++r) out.push_back(std::abs(shapes(n - 1, r)) * std::sqrt(squares[r] / n_samples));
  return out;
}

bool is_clear(double hz, const std::vector<TrueMode>& modes) {
  return std::none_of(modes.begin(), modes.end(), [&](const TrueMode& mode) {
    return std::abs(hz - mode.frequency_hz) < kClear * mode.frequency_hz;
  });
}

// What became of a line, and of the modes beside it.
struct Outcome {
  const char* called = "absent";
  int n_modes_lost_to_lines = 0;
  double beside_off = 0.0;  // relative change of the frequency of the mode beside; NaN: not found in both
};

const Mode* nearest_mode(const core::ModalEstimate& estimate, double hz) {
  const Mode* best = nullptr;
  for (const Mode& mode : estimate.modes) {
    if (std::abs(mode.frequency_hz - hz) > kSameMode * hz) continue;
    if (best == nullptr || std::abs(mode.frequency_hz - hz) < std::abs(best->frequency_hz - hz)) best = &mode;
  }
  return best;
}

bool is_line_verdict(Verdict verdict) { return verdict == Verdict::kHarmonic || verdict == Verdict::kCameraMotion; }

// A line: where it is seen, and how near a pole of its own lies.
struct Line {
  double apparent_hz = 0.0, near_hz = 0.0;
  [[nodiscard]] bool has(const Mode& pole) const { return std::abs(pole.apparent_hz - apparent_hz) < near_hz; }
};

// No pole of a mode is one of the line.
const char* called(const core::ModalEstimate& estimate, const Line& line, const std::vector<const Mode*>& true_modes) {
  for (const Mode& mode : estimate.rejected) {
    if (is_line_verdict(mode.verdict) && line.has(mode)) return "line";
  }
  for (const Mode& mode : estimate.modes) {
    const bool is_true = std::find(true_modes.begin(), true_modes.end(), &mode) != true_modes.end();
    if (!is_true && line.has(mode)) return "mode";
  }
  return "absent";
}

Outcome outcome(const core::ModalEstimate& with, const core::ModalEstimate& without, const std::vector<TrueMode>& modes,
                const Line& line, double beside_hz) {
  Outcome out;
  const Mode *after = nearest_mode(with, beside_hz), *before = nearest_mode(without, beside_hz);
  std::vector<const Mode*> found;
  for (const TrueMode& mode : modes) found.push_back(nearest_mode(with, mode.frequency_hz));
  out.called = called(with, line, found);
  out.beside_off =
      after != nullptr && before != nullptr ? std::abs(after->frequency_hz / before->frequency_hz - 1.0) : std::nan("");
  for (const TrueMode& mode : modes) {
    if (nearest_mode(with, mode.frequency_hz) != nullptr) continue;
    const double seen = apparent_hz(mode.frequency_hz, with.rate_hz);
    out.n_modes_lost_to_lines += std::any_of(with.rejected.begin(), with.rejected.end(), [&](const Mode& pole) {
      return is_line_verdict(pole.verdict) && std::abs(pole.apparent_hz - seen) < kSameMode * seen && !line.has(pole);
    });
  }
  return out;
}

core::ModalEstimate analysed(const TrustFlight& flight) {
  return analyse_flight(flight.job, flight.setup, {{"ours"}}).ways.front().measured;
}

std::string line_record(Drive drive, std::uint64_t seed, double duration_s, const GeometryOptions& options) {
  const TrustFlight flight = trust_flight(drive, seed, duration_s, options);
  const Scene& scene = flight.job.scene();
  const std::vector<TrueMode> modes = shaken_modes(scene);
  const std::vector<double> rms_mm = modal_rms_mm(scene, modes);
  const core::ModalEstimate without = analysed(flight);
  Draw draw(seed, "trust_lines");
  const auto beside = static_cast<std::size_t>(draw.whole(0, 3));
  double line_hz = 0.0, rotor_hz = 0.0;
  do line_hz = modes[beside].frequency_hz * (1.0 + draw.sign() * draw.log_uniform(0.005, 0.3));
  while (!is_clear(line_hz, modes) || line_hz > 0.48 * scene.camera.rate_hz);
  std::vector<TrueMode> seen = modes;
  for (TrueMode& mode : seen) mode.frequency_hz = apparent_hz(mode.frequency_hz, scene.camera.rate_hz);
  do rotor_hz = draw.uniform(60.0, 200.0);
  while (!is_clear(apparent_hz(rotor_hz, scene.camera.rate_hz), seen) ||
         apparent_hz(rotor_hz, scene.camera.rate_hz) < 0.5);

  std::string out;
  const double rate_hz = scene.camera.rate_hz;
  const auto add = [&](const char* kind, double ratio, double hz, double near_hz, const TrustFlight& changed) {
    const Line line{apparent_hz(hz, rate_hz), near_hz};
    const Outcome found = outcome(analysed(changed), without, modes, line, modes[beside].frequency_hz);
    out +=
        fmt::format("trust-line\t{}\t{}\t{}\t{:g}\t{:.4f}\t{:.4f}\t{}\t{}\t{:.5f}\n", word_for(drive), seed, kind,
                    ratio, hz, modes[beside].frequency_hz, found.called, found.n_modes_lost_to_lines, found.beside_off);
  };
  for (const double ratio : kRatios) {
    TrustFlight machine = flight, rotor = flight;
    Scene &of_machine = machine.job.file.scene, &of_rotor = rotor.job.file.scene;
    of_machine.excitation.harmonics.push_back({static_cast<int>(modes.size()), line_hz, ratio * rms_mm[beside]});
    add("machine", ratio, line_hz, kNearMachine * line_hz, machine);
    const double distance_mm = of_rotor.plates.front().z_mm - of_rotor.camera.z_mm;
    of_rotor.rotor.frequency_hz = rotor_hz;
    of_rotor.rotor.yaw_rms_rad = ratio * rms_mm[beside] / distance_mm;
    of_rotor.rotor.roll_rms_rad = of_rotor.rotor.pitch_rms_rad = 0.3 * of_rotor.rotor.yaw_rms_rad;
    add("rotor", ratio, rotor_hz, kNearRotor_hz, rotor);
  }
  return out;
}

}  // namespace

void print_lines_beside_modes(const GeometryOptions& options) {
  fmt::print(
      "# trust-line: what drives the structure, seed, machine or rotor, rms over that of the mode beside, Hz of the "
      "line, of "
      "the mode,\n#   what the line was called (line, mode, absent), true modes called lines, change of the mode's "
      "frequency\n");
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : 120.0;
  for (const Drive drive : {Drive::kTable, Drive::kWind}) {
    for (const std::string& record :
         for_each_seed(options, [&](std::uint64_t seed) { return line_record(drive, seed, duration_s, options); }))
      fmt::print("{}", record);
  }
}

}  // namespace tools
