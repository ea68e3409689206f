#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/compare/clock_alignment.h"

namespace core {

// One record on an even grid, sample k at k / rate_hz of its own clock; NaN = missing.
struct ComparedRecord {
  double rate_hz = 0.0;
  std::vector<double> value;
  int n_integrations = 0;  // to a displacement: 0 displacement, 1 velocity, 2 acceleration
};

struct SensorComparisonConfig {
  std::optional<Band> band;  // empty: chosen from the coherence (METHOD.md, 3)
  ClockSearch clock;
  VideoFrames frames;  // of the video that the camera's record comes from
};

// One bin of the spectra within the band that was searched, both as displacements, aligned in time.
struct ComparedBin {
  double frequency_hz = 0.0;
  double camera = 0.0, sensor = 0.0;  // one-sided densities, unit^2/Hz
  double coherence = 0.0;             // magnitude squared, 0..1
};

struct SensorComparison {
  std::string refusal;  // not empty: the rest is not set
  Band band;
  bool band_is_chosen = false;
  ClockAlignment alignment;
  std::size_t n_samples = 0;  // of the camera that were compared
  double rmse = 0.0;          // of camera - sensor with equal sign, in the records' unit
  double rmse_scaled = 0.0;   // of camera - ratio * sensor
  double sensor_rms = 0.0;    // in the band
  double correlation = 0.0;
  double coherence = 0.0;  // within the band, weighted by the camera's power
  int n_averages = 0;      // segments of the spectra
  std::vector<ComparedBin> spectrum;
  std::vector<double> t_s, camera, sensor;  // the samples compared, sensor with the camera's sign; times of the camera
};

// The camera's channel against a contact sensor, both reduced to a displacement in one band, on the camera's instants,
// clocks aligned. Values in one unit. Never throws for data; what cannot be compared is refused in words.
[[nodiscard]] SensorComparison compare_with_sensor(const ComparedRecord& camera, const ComparedRecord& sensor,
                                                   const SensorComparisonConfig& config = {});

}  // namespace core
