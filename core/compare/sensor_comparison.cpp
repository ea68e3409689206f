#include "core/compare/sensor_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "core/compare/comparison_spectrum.h"

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
  for (double low_hz = kLeastPeriods / std::min(length_s(camera), length_s(sensor)); low_hz < 0.5 * high_hz;
       low_hz *= 2.0) {
    Attempt one = attempt(camera, sensor, {low_hz, high_hz}, search);
    const double least = best.alignment.found ? best.alignment.evidence : 0.0;
    if (!one.alignment.found || one.alignment.evidence <= least) continue;
    best = std::move(one);
    band = {low_hz, high_hz};
  }
  return best;
}

void take_samples(const Attempt& done, double rate_hz, SensorComparison& out) {
  const ClockAlignment& alignment = done.alignment;
  const double sign = alignment.ratio < 0.0 ? -1.0 : 1.0;
  double cross = 0.0, camera_power = 0.0, sensor_power = 0.0, error = 0.0, scaled = 0.0;
  const auto first = static_cast<std::int64_t>(std::ceil(alignment.from_s * rate_hz));
  for (std::int64_t k = first; static_cast<double>(k) <= alignment.to_s * rate_hz; ++k) {
    const double t_s = static_cast<double>(k) / rate_hz;
    if (!counts(*done.camera, *done.sensor, out.band, alignment.clock, t_s)) continue;
    const double x = done.camera->at(t_s), y = sign * done.sensor->at(alignment.clock.sensor_s(t_s));
    out.t_s.push_back(t_s), out.camera.push_back(x), out.sensor.push_back(y);
    cross += x * y, camera_power += x * x, sensor_power += y * y;
    error += (x - y) * (x - y);
    scaled += std::pow(x - std::abs(alignment.ratio) * y, 2);
  }
  out.n_samples = out.t_s.size();
  if (out.n_samples == 0) return;
  const auto n = static_cast<double>(out.n_samples);
  out.rmse = std::sqrt(error / n), out.rmse_scaled = std::sqrt(scaled / n),
  out.sensor_rms = std::sqrt(sensor_power / n);
  out.correlation = camera_power > 0.0 && sensor_power > 0.0 ? cross / std::sqrt(camera_power * sensor_power) : 0.0;
}

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
  out.alignment = done.alignment;
  if (!done.alignment.found) {
    out.refusal = config.band ? "channel and sensor have no common motion in the band above chance"
                              : "channel and sensor have no common motion above chance in any band; name one";
    return out;
  }
  std::vector<ComparedBin> spectrum =
      compared_spectrum(*done.camera, *done.sensor, done.alignment, searched, camera.rate_hz, out.n_averages);
  if (!config.band) {
    const std::optional<Band> chosen = coherent_band(spectrum, searched, out.n_averages);
    if (!chosen) {
      out.refusal = "channel and sensor are coherent at no frequency; name a band";
      return out;
    }
    out.band = *chosen, out.band_is_chosen = true;
    const ClockAlignment start = done.alignment;
    done.camera.emplace(camera.value, camera.rate_hz, out.band, camera.n_integrations);
    done.sensor.emplace(sensor.value, sensor.rate_hz, out.band, sensor.n_integrations);
    done.alignment = out.alignment = refine_clocks(*done.camera, camera.rate_hz, *done.sensor, out.band, start);
    if (!done.alignment.found) {
      out.refusal = "the clocks cannot be aligned in the band that was chosen; name a wider one";
      return out;
    }
  }
  out.spectrum = std::move(spectrum);
  out.coherence = band_coherence(out.spectrum, out.band);
  take_samples(done, camera.rate_hz, out);
  if (out.n_samples < kLeastCompared)
    out.refusal = "fewer than 100 samples can be compared: the records hardly overlap";
  return out;
}

}  // namespace core
