// Residual diagnosis during a run: effects that are there from the start, begin in mid-flight or go away, and records
// without any.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/simulation/track_generator.h"
#include "firmware_app/replay/track_analysis.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/foreign_scene.h"
#include "tools/validate/geometry_flight.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::Scene;
using core::simulation::TrackGenerator;

constexpr double kDuration_s = 480.0, kNullDuration_s = 300.0;

// When an effect is there.
struct Presence {
  const char* name;
  double from_s, to_s;
};
constexpr std::array<Presence, 4> kPresences{
    {{"from 0 s", 0.0, 1e9}, {"from 60 s", 60.0, 1e9}, {"from 240 s", 240.0, 1e9}, {"until 300 s", 0.0, 300.0}}};

constexpr Presence kFromMidFlight{"from 90 s", 90.0, 1e9};

struct Change {
  std::uint64_t from_sequence = 0;
  std::string words;
};

struct LiveRun {
  core::ModalEstimate estimate;
  std::vector<Change> changes;
  std::vector<std::string> in_force;
};

std::string changes_text(const LiveRun& run) {
  std::string text;
  for (const Change& change : run.changes) text += "[" + change.words + "]";
  return text;
}

std::uint64_t from_of(const std::string& words) {  // "from frame N on ..."
  const std::string start = "from frame ";
  return words.starts_with(start) ? std::stoull(words.substr(start.size())) : 0;
}

// The tracks are those of `plain`, and while the effect is there those of `with`; the operator declares `plain`.
LiveRun run_live(const Scene& plain, const Scene& with, const Presence& presence, const std::string& adopt) {
  const TrackGenerator first(plain), second(with);
  SimulateJob job;
  job.file.scene = plain;
  job.depth = Depth::kTracks;
  const DeclaredRun declared =
      declared_run(job, {}, {.overrides = {"closure.adopt=" + adopt, "telemetry.lcm_url="}}, first.motion());
  std::unique_ptr<app::TrackAnalysis> analysis;
  LiveRun out;
  core::TrackFrame frame;
  auto timing = first.timing();
  for (core::simulation::DeliveredFrame delivered; timing.next(delivered);) {
    const bool is_there = delivered.t_s >= presence.from_s && delivered.t_s < presence.to_s;
    (is_there ? second : first).generate(delivered, frame);
    if (!analysis) {
      analysis = std::make_unique<app::TrackAnalysis>(declared.config, declared.camera, frame);
      analysis->hear_closure([&](const core::closure::ClosureReport& report) {
        for (const std::string& words : report.changes) {
          if (!words.starts_with("the run is measured again")) out.changes.push_back({from_of(words), words});
        }
        out.in_force = report.in_force;
      });
    }
    (void)analysis->push(frame);
  }
  out.estimate = analysis->finish();
  return out;
}

// Of the true modes below half the rate: number found, rms error, and the rms of their stated sigmas.
struct ModalError {
  int n_found = 0, n_true = 0;
  double rms_percent = std::numeric_limits<double>::quiet_NaN(), sigma_percent = rms_percent;
};
ModalError modal_error(const core::ModalEstimate& estimate, const Scene& scene) {
  constexpr double kNear = 0.05;
  ModalError out;
  double squares = 0.0, sigma_squares = 0.0;
  for (const auto& truth : core::simulation::modes_of(scene.structure)) {
    if (!(truth.frequency_hz < 0.5 * scene.camera.rate_hz)) continue;
    ++out.n_true;
    const core::Mode* best = nullptr;
    for (const core::Mode& mode : estimate.modes) {
      const double error = std::abs(mode.frequency_hz / truth.frequency_hz - 1.0);
      if (error < kNear && (best == nullptr || error < std::abs(best->frequency_hz / truth.frequency_hz - 1.0)))
        best = &mode;
    }
    if (best == nullptr) continue;
    ++out.n_found;
    squares += std::pow(100.0 * (best->frequency_hz / truth.frequency_hz - 1.0), 2);
    sigma_squares += std::pow(100.0 * best->frequency_std_hz.value_or(0.0) / truth.frequency_hz, 2);
  }
  if (out.n_found == 0) return out;
  out.rms_percent = std::sqrt(squares / out.n_found), out.sigma_percent = std::sqrt(sigma_squares / out.n_found);
  return out;
}

std::string error_text(const ModalError& e) {
  return fmt::format("{}/{}\t{:.3f}\t{:.3f}", e.n_found, e.n_true, e.rms_percent, e.sigma_percent);
}

bool withdraws(const Change& change) { return change.words.find("withdrawn") != change.words.npos; }

// Time from the onset until all of these effects are corrected; NaN if one never is.
double time_to_adoption(const LiveRun& run, const std::vector<std::string>& effects, const Presence& presence,
                        double rate_hz) {
  double latest = 0.0;
  for (const std::string& effect : effects) {
    const auto found = std::find_if(run.changes.begin(), run.changes.end(), [&](const Change& change) {
      return change.words.find("taken out, " + effect) != change.words.npos;
    });
    if (found == run.changes.end()) return std::numeric_limits<double>::quiet_NaN();
    latest = std::max(latest, static_cast<double>(found->from_sequence) / rate_hz - presence.from_s);
  }
  return latest;
}

bool names_one(const Change& change, const std::vector<std::string>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const std::string& effect) { return change.words.find(effect) != change.words.npos; });
}

// Number of changes that name none of these effects, and of withdrawals of one that is there.
long n_wrong(const LiveRun& run, const std::vector<std::string>& effects, const Presence& presence, double rate_hz) {
  return std::count_if(run.changes.begin(), run.changes.end(), [&](const Change& change) {
    const double t_s = static_cast<double>(change.from_sequence) / rate_hz;
    return !names_one(change, effects) || (withdraws(change) && t_s < presence.to_s);
  });
}

// Time from the end of the effects until all are withdrawn; NaN if one never is, or they do not end.
double time_to_withdrawal(const LiveRun& run, const std::vector<std::string>& effects, const Presence& presence,
                          double rate_hz) {
  double latest = 0.0;
  for (const std::string& effect : effects) {
    const auto found = std::find_if(run.changes.begin(), run.changes.end(), [&](const Change& change) {
      return withdraws(change) && change.words.find(effect) != change.words.npos;
    });
    if (found == run.changes.end()) return std::numeric_limits<double>::quiet_NaN();
    latest = std::max(latest, static_cast<double>(found->from_sequence) / rate_hz - presence.to_s);
  }
  return latest;
}

const std::vector<std::vector<std::string>>& live_cases() {
  static const std::vector<std::vector<std::string>> all{
      {"readout time"},
      {"radial distortion"},
      {"tangential distortion"},
      {"pixel locking"},
      {"readout time", "radial distortion"},
      {"readout time", "pixel locking"},
      {"radial distortion", "pixel locking"},
      {"tangential distortion", "pixel locking"},
  };
  return all;
}

}  // namespace

namespace {

// One record: with the loop, without it, and without the effects.
std::string live_line(const ClosureTracksOptions& options, const std::vector<std::string>& effects,
                      const Presence& presence, std::uint64_t seed) {
  RecordSetup setup;
  setup.duration_s = options.duration_s > 0.0 ? options.duration_s : kDuration_s;
  std::vector<const HiddenEffect*> hidden;
  hidden.reserve(effects.size());
  for (const std::string& effect : effects) hidden.push_back(&effect_named(effect));
  const Scene plain = closure_scene(setup, seed);
  const Scene scene =
      with_effects(hidden, plain, options.strength > 0.0 ? options.strength : 1.0, setup.background).scene;
  const LiveRun with = run_live(plain, scene, presence, "auto"), without = run_live(plain, scene, presence, "off");
  const LiveRun twin = run_live(plain, plain, presence, "off");
  const double rate_hz = plain.camera.rate_hz;
  return fmt::format("closure-live\t{}\t{}\t{}\t{:.0f}\t{:.0f}\t{}\t{}\t{}\t{}\t{}\t{}\n", fmt::join(effects, " + "),
                     presence.name, seed, time_to_adoption(with, effects, presence, rate_hz),
                     time_to_withdrawal(with, effects, presence, rate_hz), n_wrong(with, effects, presence, rate_hz),
                     with.in_force.size(), error_text(modal_error(with.estimate, plain)),
                     error_text(modal_error(without.estimate, plain)), error_text(modal_error(twin.estimate, plain)),
                     changes_text(with));
}

}  // namespace

// Without an effect named: all of them and pairs, from mid-flight on. An effect named: whenever it may be there.
void print_closure_live(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-live: effects, when they are there in {:g} s, seed, taken out after (s), withdrawn after (s), wrong "
      "changes, in force at the end; modes found, error, sigma (% rms) with the loop, without it, and without the "
      "effects; changes\n",
      kDuration_s);
  const std::span<const Presence> presences =
      options.effect.empty() ? std::span<const Presence>(&kFromMidFlight, 1) : std::span<const Presence>(kPresences);
  for (const std::vector<std::string>& effects : live_cases()) {
    if (!options.effect.empty() && options.effect != fmt::format("{}", fmt::join(effects, " + "))) continue;
    for (const Presence& presence : presences) {
      const auto lines = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        return live_line(options, effects, presence, seed_of(options, index));
      });
      for (const std::string& line : lines) fmt::print("{}", line);
      std::fflush(stdout);
    }
  }
}

// With a recorded flight given the camera hovers with power-law tails, or as recorded in one of four records.
void print_closure_live_null(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-live-null: seed, changes, largest difference of a frequency or damping ratio to the run with the loop "
      "off, in its sigma; changes; hover\n");
  const auto lines = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
    RecordSetup setup;
    setup.shaking = index % 2 == 0 ? Shaking::kWind : Shaking::kGround;
    setup.duration_s = options.duration_s > 0.0 ? options.duration_s : kNullDuration_s;
    Scene scene = closure_scene(setup, seed_of(options, index));
    std::string hover = "as the model's";
    if (!options.flight.empty())
      hover = move_camera(scene, seed_of(options, index), options.flight) ? "recorded" : "tails";
    const LiveRun with = run_live(scene, scene, kPresences[0], "auto"),
                  without = run_live(scene, scene, kPresences[0], "off");
    double worst = with.estimate.modes.size() == without.estimate.modes.size() ? 0.0 : 1e9;
    for (std::size_t m = 0; m < with.estimate.modes.size() && worst < 1e9; ++m) {
      const core::Mode &a = with.estimate.modes[m], &b = without.estimate.modes[m];
      worst = std::max({worst, std::abs(a.frequency_hz - b.frequency_hz) / b.frequency_std_hz.value_or(1e-9),
                        std::abs(a.damping_ratio - b.damping_ratio) / b.damping_std.value_or(1e-9)});
    }
    return fmt::format("closure-live-null\t{}\t{}\t{:.4f}\t{}\t{}\n", seed_of(options, index), with.changes.size(),
                       worst, changes_text(with), hover);
  });
  for (const std::string& line : lines) fmt::print("{}", line);
}

}  // namespace tools
