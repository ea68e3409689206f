// Bias, scatter and stated intervals of the identification, and the influence of lost samples.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/identification/uncertainty.h"
#include "core/simulation/random_stream.h"
#include "tools/validate/identification.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/identification_scene.h"

namespace tools {
namespace {

using core::simulation::TrueMode;

constexpr double kDegreesOfFreedom = 9.0;
constexpr double kClearPeak_db = 20.0;

// Six storeys of 1 % damping at 60 Hz, or everything drawn.
struct RecordKind {
  const char *bias, *losses;
  bool is_drawn;
};
constexpr std::array kKinds{RecordKind{"bias", "losses", false}, RecordKind{"bias-drawn", "losses-drawn", true}};

StoreysSetup long_record(bool is_drawn, std::uint64_t seed) {
  const StoreysSetup fixed{.duration_s = 300.0, .rate_hz = 60.0};
  return is_drawn ? drawn_storeys(fixed, seed) : fixed;
}

// Limit of the search for alias orders, if a mode may lie near half the rate or above: 0 = no search.
double search_limit_hz(const StoreysSetup& setup) {
  return setup.frequency_hz.back() > 0.45 * setup.rate_hz ? fold_limit_hz(setup.rate_hz) : 0.0;
}

// One mode over all records that contain it.
struct Errors {
  std::vector<double> peaks_db;
  std::vector<double> frequency, damping;                // relative
  std::vector<double> frequency_bounds, damping_bounds;  // over the least possible scatter
  int n_stated = 0, n_frequency_inside = 0, n_damping_inside = 0;
};

bool inside(double value, const core::Interval& interval) { return value >= interval.low && value <= interval.high; }
bool inside(double error, double standard_deviation) {
  return std::abs(error) <= core::student_95(kDegreesOfFreedom) * standard_deviation;
}

void add(Errors& errors, const Found& found, const TrueMode& truth, double peak_db, double duration_s) {
  errors.peaks_db.push_back(peak_db);
  if (found.as != Found::As::kRight) return;
  const double df = found.mode.frequency_hz - truth.frequency_hz;
  const double dz = found.mode.damping_ratio - truth.damping_ratio;
  const double cycles = 2.0 * std::numbers::pi * truth.frequency_hz * duration_s;
  errors.frequency.push_back(df / truth.frequency_hz);
  errors.damping.push_back(dz / truth.damping_ratio);
  errors.frequency_bounds.push_back(errors.frequency.back() / std::sqrt(truth.damping_ratio / cycles));
  errors.damping_bounds.push_back(errors.damping.back() * std::sqrt(truth.damping_ratio * cycles));
  if (!found.mode.frequency_std_hz || !found.mode.damping_std) return;
  ++errors.n_stated;
  errors.n_frequency_inside += inside(df, *found.mode.frequency_std_hz) ? 1 : 0;
  const auto interval = core::damping_interval_95(found.mode, kDegreesOfFreedom);
  errors.n_damping_inside += interval && inside(truth.damping_ratio, *interval) ? 1 : 0;
}

std::string percent(int part, int whole) { return whole > 0 ? fmt::format("{:.1f}", 100.0 * part / whole) : "nan"; }

void print_mode(const char* tag, const char* variant, const std::string& mode, bool is_clear, const Errors& errors) {
  const Statistics f = statistics(errors.frequency), z = statistics(errors.damping);
  fmt::print("{}\t{}\t{}\t{:.1f}\t{}\t{}\t{:+.4f}\t{:.4f}\t{:+.2f}\t{:.2f}\t{:+.2f}\t{:.3f}\t{:.3f}\t{}\t{}\t{}\n", tag,
             variant, mode, statistics(errors.peaks_db).median, is_clear ? "clear" : "weak", f.n, 1e2 * f.mean,
             1e2 * f.standard_error, 1e2 * z.mean, 1e2 * z.standard_error, 1e2 * z.median,
             statistics(errors.frequency_bounds).standard_deviation,
             statistics(errors.damping_bounds).standard_deviation, percent(errors.n_frequency_inside, errors.n_stated),
             percent(errors.n_damping_inside, errors.n_stated), errors.peaks_db.size());
}

struct BiasRecord {
  std::vector<TrueMode> truth;
  std::vector<double> peaks_db;
  double duration_s = 0.0;
  Match corrected, uncorrected;
};

void print_variant(const RecordKind& kind, const char* variant, const std::vector<BiasRecord>& records,
                   Match BiasRecord::*which) {
  int n_false = 0, n_stated = 0, n_frequency_inside = 0, n_damping_inside = 0;
  for (const BiasRecord& record : records) n_false += (record.*which).n_false;
  for (std::size_t r = 0; r < kMostStoreys; ++r) {
    for (const bool is_clear : {true, false}) {
      Errors errors;
      for (const BiasRecord& record : records) {
        if (r >= record.truth.size() || (record.peaks_db[r] >= kClearPeak_db) != is_clear) continue;
        add(errors, (record.*which).modes[r], record.truth[r], record.peaks_db[r], record.duration_s);
      }
      if (errors.peaks_db.empty()) continue;
      print_mode(kind.bias, variant,
                 kind.is_drawn ? std::to_string(r + 1) : fmt::format("{:.3f}", records.front().truth[r].frequency_hz),
                 is_clear, errors);
      n_stated += errors.n_stated;
      n_frequency_inside += errors.n_frequency_inside;
      n_damping_inside += errors.n_damping_inside;
    }
  }
  fmt::print("{}-all\t{}\t{}\t{}\t{}\t{}\n", kind.bias, variant, records.size(), n_false,
             percent(n_frequency_inside, n_stated), percent(n_damping_inside, n_stated));
}

BiasRecord bias_record(bool is_drawn, std::uint64_t seed) {
  const StoreysSetup setup = long_record(is_drawn, seed);
  const core::simulation::Scene scene = storeys_scene(setup, seed);
  const std::vector<TrueMode> truth = modes_of(scene.structure);
  const Record record = structure_record(scene, false);
  const core::CpsdSums sums = spectra(record);
  const core::Identifier identifier(identifier_config(search_limit_hz(setup)), record.channels);
  return {truth, peaks_over_noise_db(scene), scene.duration_s,
          match_modes(identifier.identify(sums), truth, record.channels),
          match_modes(identifier.identify(without_window_correction(sums)), truth, record.channels)};
}

}  // namespace

void print_bias(const IdentificationOptions& options) {
  fmt::print(
      "# bias: window corrected or not, true Hz, peak over noise dB, clear from 20 dB on, records in which it is "
      "found,\n"
      "#   f: mean error %, its standard error; damping: mean error %, its standard error, median;\n"
      "#   scatter over its bound: f, damping; stated 95 % intervals that hold the truth, %: f, damping (nan: none\n"
      "#   stated); records that have it\n"
      "# bias-all: window corrected or not, records, structural poles that are no mode, coverage over all modes %: f, "
      "damping\n"
      "# bias-drawn, bias-drawn-all: the same with camera, structure and noise drawn; number of the mode for its Hz,\n"
      "#   median of its peaks\n");
  for (const RecordKind& kind : kKinds) {
    const auto records = for_each_seed(options, [&](std::uint64_t seed) { return bias_record(kind.is_drawn, seed); });
    print_variant(kind, "corrected", records, &BiasRecord::corrected);
    print_variant(kind, "uncorrected", records, &BiasRecord::uncorrected);
  }
}

namespace {

constexpr std::size_t kJudgedModes = 3;
constexpr double kLosses[] = {0.0, 0.01, 0.05, 0.3};

// Each sample, or each whole frame, is lost independently.
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

// Frequency of the first modes relative to the same record without losses, in percent; empty: not found.
using Shifts = std::array<std::optional<double>, kJudgedModes>;

std::vector<Shifts> shifts_of(bool is_drawn, std::uint64_t seed) {
  const StoreysSetup setup = long_record(is_drawn, seed);
  const core::simulation::Scene scene = storeys_scene(setup, seed);
  const std::vector<TrueMode> truth = modes_of(scene.structure);
  const double limit_hz = search_limit_hz(setup);
  const Record whole = structure_record(scene, false);
  const Match reference = match_modes(identify_record(whole, limit_hz), truth, whole.channels);
  std::vector<Shifts> shifts;
  for (const LossCase& loss : loss_cases()) {
    const Record lossy = with_losses(whole, loss.probability, loss.whole_frames, seed);
    const Match match = match_modes(identify_record(lossy, limit_hz, loss.bridged), truth, lossy.channels);
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
  fmt::print(
      "# losses: bridged or masked, what is lost, share lost %, true Hz, records in which it is found, of; f against "
      "the estimate\n"
      "#   without losses of the same record, %: median magnitude, worst\n"
      "# losses-drawn: the same with camera, structure and noise drawn; number of the mode for its Hz\n");
  const std::vector<LossCase> cases = loss_cases();
  for (const RecordKind& kind : kKinds) {
    const auto records = for_each_seed(options, [&](std::uint64_t seed) { return shifts_of(kind.is_drawn, seed); });
    for (std::size_t i = 0; i < cases.size(); ++i) {
      for (std::size_t r = 0; r < kJudgedModes; ++r) {
        std::vector<double> magnitude;
        for (const auto& record : records) {
          if (record[i][r]) magnitude.push_back(std::abs(*record[i][r]));
        }
        const Statistics s = statistics(magnitude);
        fmt::print("{}\t{}\t{}\t{:.0f}\t{}\t{}\t{}\t{:.4f}\t{:.4f}\n", kind.losses,
                   cases[i].bridged ? "bridged" : "masked", cases[i].whole_frames ? "frames" : "samples",
                   1e2 * cases[i].probability,
                   kind.is_drawn ? std::to_string(r + 1) : fmt::format("{:.3f}", storey_frequencies_hz()[r]), s.n,
                   records.size(), s.median, s.worst);
      }
    }
  }
}

}  // namespace tools
