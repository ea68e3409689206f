#include "core/compare/sensor_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "core/compare/comparison_spectrum.h"
#include "core/types/constants.h"

namespace core {
namespace {

constexpr double kHighestShare = 0.42;  // of the lower rate: the upper limit of a band that is chosen
constexpr double kLeastPeriods = 10.0;  // of the lower limit within the shorter record
constexpr std::size_t kLeastCompared = 100;

// One comparison in a given band; empty where the clocks cannot be aligned.
struct Attempt {
  std::optional<BandLimited> camera, sensor;
  ClockAlignment alignment;
};

Attempt attempt(const ComparedRecord& camera, const ComparedRecord& sensor, const Band& band,
                const ClockSearch& search) {
  Attempt out;
  out.camera.emplace(camera.value, camera.rate_hz, band, camera.n_integrations);
  out.sensor.emplace(sensor.value, sensor.rate_hz, band, sensor.n_integrations);
  out.alignment = align_clocks(*out.camera, camera.rate_hz, *out.sensor, band, search);
  return out;
}

double length_s(const ComparedRecord& record) { return static_cast<double>(record.value.size()) / record.rate_hz; }

// The lower limit for which the records agree best: below it drift of the camera, or integrated noise of the sensor,
// outweighs the common motion.
Attempt widest(const ComparedRecord& camera, const ComparedRecord& sensor, const ClockSearch& search, Band& band) {
  const double high_hz = kHighestShare * std::min(camera.rate_hz, sensor.rate_hz);
  Attempt best;
  const double lowest_hz = kLeastPeriods / std::min(length_s(camera), length_s(sensor));
  const int n_doublings = std::max(0, static_cast<int>(std::ceil(std::log2(0.5 * high_hz / lowest_hz))));
  for (int doubling = 0; doubling < n_doublings; ++doubling) {
    const double low_hz = std::ldexp(lowest_hz, doubling);
    Attempt one = attempt(camera, sensor, {low_hz, high_hz}, search);
    const double least = best.alignment.found ? best.alignment.evidence : 0.0;
    if (!one.alignment.found || one.alignment.evidence <= least) continue;
    best = std::move(one);
    band = {low_hz, high_hz};
  }
  return best;
}

// Both records at the camera's instants within what they share: what their ends do to the band is then the same for
// both, and cancels in their difference.
struct SharedRecords {
  double first_s = 0.0;  // camera time of the first sample
  std::vector<double> camera, sensor;
};

class SharedComparison {
 public:
  SharedComparison(const ComparedRecord& camera, const ComparedRecord& sensor, const Band& band)
      : camera_(camera),
        band_(band),
        wide_sensor_(sensor.value, sensor.rate_hz, wide(sensor, band), sensor.n_integrations) {
    if (camera.n_integrations != 0)
      wide_camera_.emplace(camera.value, camera.rate_hz, wide(camera, band), camera.n_integrations);
  }

  // The relation is fitted to the shared records twice, each time from the one before. False: no convergence.
  bool refine(ClockAlignment& alignment, const VideoFrames& frames) {
    for (int round = 0; round < 2; ++round) {
      cut(alignment);
      if (shared_.camera.size() < kLeastCompared) return false;
      ClockAlignment rest = alignment;
      rest.clock = {};
      rest.from_s = 0.0, rest.to_s = static_cast<double>(shared_.camera.size()) / camera_.rate_hz;
      rest.clock.middle_s = alignment.clock.middle_s - shared_.first_s;
      rest = refine_clocks(*camera_in_band_, camera_.rate_hz, *sensor_in_band_, band_, rest, frames);
      if (!rest.found) return false;
      alignment.ratio = rest.ratio, alignment.ratio_std = rest.ratio_std;
      alignment.frame_share = rest.frame_share, alignment.frame_share_std = rest.frame_share_std;
      alignment.clock.offset_s += rest.clock.offset_s, alignment.clock.rate += rest.clock.rate;
      alignment.clock.offset_std_s = rest.clock.offset_std_s, alignment.clock.rate_std = rest.clock.rate_std;
    }
    cut(alignment);
    return true;
  }

  void measure(const ClockAlignment& alignment, SensorComparison& out) {
    ClockAlignment same = alignment;
    same.clock = {};
    same.from_s = 0.0, same.to_s = static_cast<double>(shared_.camera.size()) / camera_.rate_hz;
    out.spectrum = compared_spectrum(*camera_in_band_, *sensor_in_band_, same, band_, camera_.rate_hz, out.n_averages);
    out.coherence = band_coherence(out.spectrum, band_);
    const double sign = alignment.ratio < 0.0 ? -1.0 : 1.0;
    double cross = 0.0, camera_power = 0.0, sensor_power = 0.0, error = 0.0, scaled = 0.0;
    for (std::size_t k = 0; k < shared_.camera.size(); ++k) {
      const double t_s = static_cast<double>(k) / camera_.rate_hz;
      if (!counts(*camera_in_band_, *sensor_in_band_, band_, same.clock, t_s)) continue;
      const double x = camera_in_band_->at(t_s), y = sign * sensor_in_band_->at(t_s);
      out.t_s.push_back(shared_.first_s + t_s), out.camera.push_back(x), out.sensor.push_back(y);
      cross += x * y, camera_power += x * x, sensor_power += y * y;
      error += (x - y) * (x - y);
      scaled += std::pow(x - std::abs(alignment.ratio) * y, 2);
    }
    out.n_samples = out.t_s.size();
    if (out.n_samples == 0) return;
    const auto n = static_cast<double>(out.n_samples);
    out.rmse = std::sqrt(error / n), out.rmse_scaled = std::sqrt(scaled / n),
    out.sensor_rms = std::sqrt(sensor_power / n);
    const double power = camera_power * sensor_power;
    out.correlation = power > 0.0 ? cross / std::sqrt(power) : 0.0;
  }

 private:
  static Band wide(const ComparedRecord& record, const Band& band) {
    return {record.n_integrations == 0 ? 0.0 : 0.5 * band.low_hz, std::min(1.3 * band.high_hz, 0.49 * record.rate_hz)};
  }

  void cut(const ClockAlignment& alignment) {
    shared_ = {};
    const auto first = static_cast<std::int64_t>(std::ceil(alignment.from_s * camera_.rate_hz));
    shared_.first_s = static_cast<double>(first) / camera_.rate_hz;
    for (auto k = static_cast<std::size_t>(first); k < camera_.value.size(); ++k) {
      const double t_s = static_cast<double>(k) / camera_.rate_hz, sensor_s = alignment.clock.sensor_s(t_s);
      if (t_s > alignment.to_s || sensor_s > wide_sensor_.duration_s()) break;
      const bool is_camera_seen = !wide_camera_ || wide_camera_->is_seen(t_s);
      shared_.camera.push_back(!is_camera_seen ? kNan : wide_camera_ ? wide_camera_->at(t_s) : camera_.value[k]);
      shared_.sensor.push_back(wide_sensor_.is_seen(sensor_s) ? wide_sensor_.at(sensor_s) : kNan);
    }
    if (shared_.camera.size() < kLeastCompared) return;
    camera_in_band_.emplace(shared_.camera, camera_.rate_hz, band_, 0);
    sensor_in_band_.emplace(shared_.sensor, camera_.rate_hz, band_, 0);
  }

  const ComparedRecord& camera_;
  Band band_;
  BandLimited wide_sensor_;
  std::optional<BandLimited> wide_camera_, camera_in_band_, sensor_in_band_;
  SharedRecords shared_;
};

std::string fault_of(const ComparedRecord& record, const char* name) {
  if (!(record.rate_hz > 0.0) || record.value.size() < 64)
    return std::string("the ") + name + " has fewer than 64 samples, or no rate";
  const auto n_seen =
      std::count_if(record.value.begin(), record.value.end(), [](double x) { return std::isfinite(x); });
  if (2 * static_cast<std::size_t>(n_seen) < record.value.size())
    return std::string("more than half of the ") + name + "'s samples are missing";
  return {};
}

std::string fault_of(const Band& band, const ComparedRecord& camera, const ComparedRecord& sensor) {
  if (!(band.low_hz > 0.0 && band.high_hz > band.low_hz)) return "the band's limits are not 0 < low < high";
  if (!(band.high_hz < 0.5 * std::min(camera.rate_hz, sensor.rate_hz)))
    return "the band's upper limit is not below half the lower rate";
  if (band.low_hz * std::min(length_s(camera), length_s(sensor)) < 2.0)
    return "the shorter record has fewer than two periods of the band's lower limit";
  return {};
}

}  // namespace

SensorComparison compare_with_sensor(const ComparedRecord& camera, const ComparedRecord& sensor,
                                     const SensorComparisonConfig& config) {
  SensorComparison out;
  out.refusal = fault_of(camera, "channel");
  if (out.refusal.empty()) out.refusal = fault_of(sensor, "sensor");
  if (out.refusal.empty() && config.band) out.refusal = fault_of(*config.band, camera, sensor);
  if (!out.refusal.empty()) return out;

  Attempt done;
  Band searched;
  if (config.band) {
    searched = out.band = *config.band;
    done = attempt(camera, sensor, out.band, config.clock);
  } else {
    done = widest(camera, sensor, config.clock, searched);
  }
  if (!done.alignment.found) {
    out.refusal = config.band ? "channel and sensor have no common motion in the band above chance"
                              : "channel and sensor have no common motion above chance in any band; name one";
    return out;
  }
  if (!config.band) {
    const std::vector<ComparedBin> spectrum =
        compared_spectrum(*done.camera, *done.sensor, done.alignment, searched, camera.rate_hz, out.n_averages);
    const std::optional<Band> chosen = coherent_band(spectrum, searched, out.n_averages);
    if (!chosen) {
      out.refusal = "channel and sensor are coherent at no frequency; name a band";
      return out;
    }
    out.band = *chosen, out.band_is_chosen = true;
  }
  SharedComparison shared(camera, sensor, out.band);
  if (!shared.refine(done.alignment, config.frames)) {
    out.refusal = "the clocks cannot be aligned in the band, or the records hardly overlap; name a wider band";
    return out;
  }
  out.alignment = done.alignment;
  shared.measure(out.alignment, out);
  if (out.n_samples < kLeastCompared)
    out.refusal = "fewer than 100 samples can be compared: the records hardly overlap";
  return out;
}

}  // namespace core
