// Modes found, poles wrongly called modes, and the stated intervals, record by record.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/identification/mac.h"
#include "core/identification/uncertainty.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/geometry_score.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/trust.h"
#include "tools/validate/trust_scene.h"
#include "tools/validate/trust_shaking.h"

namespace tools {
namespace {

using core::Mode;
using core::simulation::TrueMode;
using Shape = std::vector<std::complex<double>>;

struct TrustCase {
  Drive drive = Drive::kTable;
  Disturbance disturbance = Disturbance::kNone;
};

// Relative to the base, without the base itself.
Shape relative_to_base(const Shape& shape, const std::vector<core::ChannelInfo>& channels) {
  const auto base = std::find_if(channels.begin(), channels.end(), [](const auto& c) { return c.is_base; });
  const std::complex<double> moved =
      base == channels.end() ? 0.0 : shape[static_cast<std::size_t>(base - channels.begin())];
  Shape out;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (!channels[c].is_base) out.push_back(shape[c] - moved);
  }
  return out;
}

// Components whose true value lies within the stated 95 % interval, and of how many.
struct Inside {
  int n = 0, of = 0;
};
Inside shape_inside(const Mode& mode, const Shape& truth, double t_95) {
  Inside out;
  std::size_t largest = 0;
  for (std::size_t c = 0; c < mode.shape.size(); ++c) {
    if (std::norm(mode.shape[c]) > std::norm(mode.shape[largest])) largest = c;
  }
  for (std::size_t c = 0; c < mode.shape_std.size(); ++c) {
    if (c == largest || mode.shape_std[c] == 0.0) continue;  // 1, or 0 of a measured input, by definition
    ++out.of;
    const double off = mode.shape[c].real() - (truth[c] / truth[largest]).real();
    if (std::abs(off) <= t_95 * mode.shape_std[c]) ++out.n;
  }
  return out;
}

void print_mode(const std::string& key, std::size_t number, const Found& found, const TrueMode& truth,
                const Analysed& way) {
  const Mode& mode = found.mode;
  const double nan = std::nan(""), freedom = way.measured.degrees_of_freedom, t_95 = core::student_95(freedom);
  const bool is_found = found.as == Found::As::kRight;
  const double sigma_hz = mode.frequency_std_hz.value_or(nan), sigma_zeta = mode.damping_std.value_or(nan);
  const auto interval = core::damping_interval_95(mode, freedom);
  const Shape shape = true_shape(truth, way.channels);
  const Inside inside = is_found ? shape_inside(mode, shape, t_95) : Inside{};
  const double mac =
      is_found ? core::mac(relative_to_base(mode.shape, way.channels), relative_to_base(shape, way.channels)) : nan;
  fmt::print(
      "trust-mode\t{}\t{}\t{:.4f}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.2f}\t{:.5f}\t{:.5f}\t{:.5f}\t{}\t{}\t{}\t{}\t{:.5f}\n",
      key, number, truth.frequency_hz, truth.frequency_hz > 0.5 * way.measured.rate_hz ? "folded" : "below",
      is_found ? "found" : "absent", mode.frequency_hz, sigma_hz, freedom, truth.damping_ratio, mode.damping_ratio,
      sigma_zeta,
      std::isfinite(sigma_hz) ? std::to_string(int(std::abs(mode.frequency_hz - truth.frequency_hz) <= t_95 * sigma_hz))
                              : "-",
      interval ? std::to_string(int(truth.damping_ratio >= interval->low && truth.damping_ratio <= interval->high))
               : "-",
      inside.n, inside.of, mac);
}

// The pole that is nearest to a mode that was not found, and why it is none; every structural pole that is no mode.
void print_poles(const std::string& key, const Match& match, const std::vector<TrueMode>& truth, const Analysed& way) {
  for (std::size_t r = 0; r < truth.size(); ++r) {
    if (match.modes[r].as == Found::As::kRight) continue;
    for (const Mode& mode : way.measured.rejected) {
      if (std::abs(mode.apparent_hz - apparent_hz(truth[r].frequency_hz, way.measured.rate_hz)) >
          0.02 * truth[r].frequency_hz)
        continue;
      fmt::print("trust-rejected\t{}\t{}\t{:.4f}\t{:.4f}\t{}\t{}\n", key, r + 1, truth[r].frequency_hz,
                 mode.frequency_hz, core::to_string(mode.verdict), mode.reason);
    }
  }
  for (const Mode& mode : way.measured.modes) {
    const bool is_mode = std::any_of(match.modes.begin(), match.modes.end(), [&](const Found& found) {
      return found.as == Found::As::kRight && found.mode.frequency_hz == mode.frequency_hz;
    });
    if (!is_mode)
      fmt::print("trust-false\t{}\t{:.4f}\t{:.4f}\t{}\n", key, mode.frequency_hz, mode.damping_ratio, mode.reason);
  }
}

std::string key_of(const TrustCase& which, std::uint64_t seed, double duration_s) {
  const char* drive = word_for(which.drive);
  return which.disturbance == Disturbance::kNone
             ? fmt::format("{}\t{:g}\t{}", drive, duration_s, seed)
             : fmt::format("{}+{}\t{:g}\t{}", drive, word_for(which.disturbance), duration_s, seed);
}

void print_trust_record(const std::string& key, const TrustFlight& flight, const Analysed& way) {
  const auto truth = shaken_modes(flight.job.scene());
  const Match match = match_modes(way.measured, truth, way.channels);
  const auto n_stated = std::count_if(way.measured.modes.begin(), way.measured.modes.end(),
                                      [](const Mode& mode) { return mode.frequency_std_hz && mode.damping_std; });
  const auto n_wrong = std::count_if(match.modes.begin(), match.modes.end(),
                                     [](const Found& found) { return found.as == Found::As::kWrongFold; });
  fmt::print("trust-record\t{}\t{}\t{}\t{}\t{}\t{}\n", key, flight.hover, way.measured.n_segments,
             way.measured.modes.size(), n_stated, match.n_false + n_wrong);
  for (std::size_t r = 0; r < truth.size(); ++r) print_mode(key, r + 1, match.modes[r], truth[r], way);
  print_poles(key, match, truth, way);
}

TrustFlight disturbed_flight(const TrustCase& which, std::uint64_t seed, double duration_s,
                             const GeometryOptions& options) {
  TrustFlight out = trust_flight(which.drive, seed, duration_s, options);
  if (which.disturbance == Disturbance::kLosses)
    out.job.file.scene.timing.drop_probability = Draw(seed, "trust_losses").uniform(0.1, 0.3);
  if (which.disturbance == Disturbance::kVibration) (void)shake_camera(out, which.drive, seed);
  return out;
}

void print_cases(const std::vector<TrustCase>& cases, const GeometryOptions& options) {
  fmt::print(
      "# all: what drives the structure (and disturbs the record), s, seed\n"
      "# trust-record: hover, segments, structural poles, of them with a stated sigma, those that are no mode\n"
      "# trust-mode: number, true Hz, below or folded (half the rate), found or absent, Hz, sigma, degrees of "
      "freedom,\n"
      "#   true damping, damping, sigma, truth within the 95 % interval of f, of damping, shape components within, "
      "of,\n"
      "#   MAC of the shapes relative to the base\n"
      "# trust-rejected: number, true Hz, Hz, verdict, reason; trust-false: Hz, damping, reason\n");
  const double duration_s = options.duration_s > 0.0 ? options.duration_s : 120.0;
  for (const TrustCase& which : cases) {
    struct Flown {
      TrustFlight flight;
      AnalysedFlight result;
    };
    const auto records = for_each_seed(options, [&](std::uint64_t seed) {
      Flown out{disturbed_flight(which, seed, duration_s, options), {}};
      out.result = analyse_flight(out.flight.job, out.flight.setup, {{"ours"}});
      return out;
    });
    for (std::size_t i = 0; i < records.size(); ++i) {
      const std::uint64_t seed = static_cast<std::uint64_t>(options.first_seed) + i;
      print_trust_record(key_of(which, seed, duration_s), records[i].flight, records[i].result.ways.front());
    }
  }
}

}  // namespace

void print_trust_modes(const GeometryOptions& options) {
  std::vector<TrustCase> cases;
  cases.reserve(kDrives.size());
  for (const Drive drive : kDrives) cases.push_back({drive});
  print_cases(cases, options);
}

void print_trust_disturbed(const GeometryOptions& options) {
  std::vector<TrustCase> cases;
  for (const Disturbance disturbance : {Disturbance::kLosses, Disturbance::kVibration}) {
    for (const Drive drive : {Drive::kTable, Drive::kWind}) cases.push_back({drive, disturbance});
  }
  print_cases(cases, options);
}

}  // namespace tools
