// Bias, scatter and stated intervals of the identification, and what the losses of samples do to it.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/identification/uncertainty.h"
#include "core/simulation/random_stream.h"
#include "tools/hovermodal/selftest/identification.h"
#include "tools/hovermodal/selftest/identification_match.h"
#include "tools/hovermodal/selftest/identification_parallel.h"
#include "tools/hovermodal/selftest/identification_scene.h"

namespace tools {
namespace {

using core::simulation::TrueMode;

constexpr double kDegreesOfFreedom = 9.0;
constexpr double kClearPeak_db = 20.0;

// One mode over all records.
struct Errors {
  std::vector<double> frequency, damping;  // relative
  int n_stated = 0, n_frequency_inside = 0, n_damping_inside = 0;
};

bool inside(double value, const core::Interval& interval) { return value >= interval.low && value <= interval.high; }
bool inside(double error, double standard_deviation) {
  return std::abs(error) <= core::student_95(kDegreesOfFreedom) * standard_deviation;
}

void add(Errors& errors, const Found& found, const TrueMode& truth) {
  if (found.as != Found::As::kRight) return;
  const double df = found.mode.frequency_hz - truth.frequency_hz;
  const double dz = found.mode.damping_ratio - truth.damping_ratio;
  errors.frequency.push_back(df / truth.frequency_hz);
  errors.damping.push_back(dz / truth.damping_ratio);
  if (!found.mode.frequency_std_hz || !found.mode.damping_std) return;
  ++errors.n_stated;
  errors.n_frequency_inside += inside(df, *found.mode.frequency_std_hz) ? 1 : 0;
  const auto interval = core::damping_interval_95(found.mode, kDegreesOfFreedom);
  errors.n_damping_inside += interval && inside(truth.damping_ratio, *interval) ? 1 : 0;
}

std::string percent(int part, int whole) { return whole > 0 ? fmt::format("{:.1f}", 100.0 * part / whole) : "-"; }

void print_mode(const char* variant, const TrueMode& truth, double peak_db, const Errors& errors, double duration_s) {
  const double cycles = 2.0 * std::numbers::pi * truth.frequency_hz * duration_s;
  const double f_bound = std::sqrt(truth.damping_ratio / cycles),
               z_bound = 1.0 / std::sqrt(truth.damping_ratio * cycles);
  const Statistics f = statistics(errors.frequency), z = statistics(errors.damping);
  fmt::print("bias\t{}\t{:.3f}\t{:.1f}\t{}\t{}\t{:+.4f}\t{:.4f}\t{:+.2f}\t{:.2f}\t{:+.2f}\t{:.3f}\t{:.3f}\t{}\t{}\n",
             variant, truth.frequency_hz, peak_db, peak_db >= kClearPeak_db ? "clear" : "weak", f.n, 1e2 * f.mean,
             1e2 * f.standard_error, 1e2 * z.mean, 1e2 * z.standard_error, 1e2 * z.median,
             f.standard_deviation / f_bound, z.standard_deviation / z_bound,
             percent(errors.n_frequency_inside, errors.n_stated), percent(errors.n_damping_inside, errors.n_stated));
}

struct BothWays {
  Match corrected, uncorrected;
};

void print_variant(const char* variant, const std::vector<BothWays>& records, Match BothWays::*which,
                   const std::vector<TrueMode>& truth, const std::vector<double>& peaks_db, double duration_s) {
  int n_false = 0, n_stated = 0, n_frequency_inside = 0, n_damping_inside = 0;
  for (const BothWays& record : records) n_false += (record.*which).n_false;
  for (std::size_t r = 0; r < truth.size(); ++r) {
    Errors errors;
    for (const BothWays& record : records) add(errors, (record.*which).modes[r], truth[r]);
    print_mode(variant, truth[r], peaks_db[r], errors, duration_s);
    n_stated += errors.n_stated;
    n_frequency_inside += errors.n_frequency_inside;
    n_damping_inside += errors.n_damping_inside;
  }
  fmt::print("bias-all\t{}\t{}\t{}\t{}\t{}\n", variant, records.size(), n_false, percent(n_frequency_inside, n_stated),
             percent(n_damping_inside, n_stated));
}

StoreysSetup long_record() { return {.duration_s = 300.0, .rate_hz = 60.0}; }

}  // namespace

void print_bias(const IdentificationOptions& options) {
  const core::simulation::Scene scene = storeys_scene(long_record(), 1);
  const std::vector<TrueMode> truth = modes_of(scene.structure);
  const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t seed) {
    const Record record = structure_record(storeys_scene(long_record(), seed), false);
    const core::CpsdSums sums = spectra(record);
    const core::Identifier identifier(identifier_config(), record.channels);
    return BothWays{match_modes(identifier.identify(sums), truth, record.channels),
                    match_modes(identifier.identify(without_window_correction(sums)), truth, record.channels)};
  });
  fmt::print(
      "# bias: window corrected or not, true Hz, peak over noise dB, clear from 20 dB on, records in which it is "
      "found,\n"
      "#   f: mean error %, its standard error; damping: mean error %, its standard error, median;\n"
      "#   scatter over its bound: f, damping; stated 95 % intervals that hold the truth, %: f, damping (- none "
      "stated)\n"
      "# bias-all: window corrected or not, records, structural poles that are no mode, coverage over all modes %: f, "
      "damping\n");
  const std::vector<double> peaks_db = peaks_over_noise_db(scene);
  print_variant("corrected", records, &BothWays::corrected, truth, peaks_db, scene.duration_s);
  print_variant("uncorrected", records, &BothWays::uncorrected, truth, peaks_db, scene.duration_s);
}

namespace {

constexpr std::size_t kJudgedModes = 3;
constexpr double kLosses[] = {0.0, 0.01, 0.05, 0.3};

// Each sample, or each whole frame, is lost by itself.
Record with_losses(Record record, double probability, bool whole_frames, std::uint64_t seed) {
  const std::size_t n = record.channels.size();
  core::simulation::RandomStream loss(seed, whole_frames ? "frame_loss" : "sample_loss");
  for (std::size_t k = 0; k < record.n_samples(); ++k) {
    const bool frame_lost = whole_frames && loss.uniform() < probability;
    for (std::size_t c = 0; c < n; ++c) {
      if (whole_frames ? frame_lost : loss.uniform() < probability) record.seen[k * n + c] = 0;
    }
  }
  return record;
}

struct LossCase {
  double probability;
  bool whole_frames, bridged;
};

std::vector<LossCase> loss_cases() {
  std::vector<LossCase> cases;
  for (const bool bridged : {true, false}) {
    for (const bool whole_frames : {false, true}) {
      for (const double p : kLosses) cases.push_back({p, whole_frames, bridged});
    }
  }
  return cases;
}

// f of the first modes against the same record without losses, in percent; empty: not found.
using Shifts = std::array<std::optional<double>, kJudgedModes>;

std::vector<Shifts> shifts_of(std::uint64_t seed, const std::vector<TrueMode>& truth) {
  const Record whole = structure_record(storeys_scene(long_record(), seed), false);
  const Match reference = match_modes(identify_record(whole), truth, whole.channels);
  std::vector<Shifts> shifts;
  for (const LossCase& loss : loss_cases()) {
    const Record lossy = with_losses(whole, loss.probability, loss.whole_frames, seed);
    const Match match = match_modes(identify_record(lossy, 0.0, loss.bridged), truth, lossy.channels);
    Shifts& shift = shifts.emplace_back();
    for (std::size_t r = 0; r < kJudgedModes; ++r) {
      if (match.modes[r].as != Found::As::kRight || reference.modes[r].as != Found::As::kRight) continue;
      shift[r] = 1e2 * (match.modes[r].mode.frequency_hz / reference.modes[r].mode.frequency_hz - 1.0);
    }
  }
  return shifts;
}

}  // namespace

void print_losses(const IdentificationOptions& options) {
  const std::vector<TrueMode> truth = modes_of(storeys_scene(long_record(), 1).structure);
  const auto records =
      for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t seed) { return shifts_of(seed, truth); });
  fmt::print(
      "# losses: bridged or masked, what is lost, share lost %, true Hz, records in which it is found, of; f against "
      "the estimate "
      "without\n"
      "#   losses of the same record, %: median magnitude, worst\n");
  const std::vector<LossCase> cases = loss_cases();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (std::size_t r = 0; r < kJudgedModes; ++r) {
      std::vector<double> magnitude;
      for (const auto& record : records) {
        if (record[i][r]) magnitude.push_back(std::abs(*record[i][r]));
      }
      const Statistics s = statistics(magnitude);
      fmt::print("losses\t{}\t{}\t{:.0f}\t{:.3f}\t{}\t{}\t{:.4f}\t{:.4f}\n", cases[i].bridged ? "bridged" : "masked",
                 cases[i].whole_frames ? "frames" : "samples", 1e2 * cases[i].probability, truth[r].frequency_hz, s.n,
                 records.size(), s.median, s.worst);
    }
  }
}

}  // namespace tools
