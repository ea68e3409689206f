#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace drivers {

// A run as it is handed to other programs: the same numbers for every format. Plain data, without channels' history.
struct ExchangeNode {
  std::string name;         // of the region
  double x = 0.0, y = 0.0;  // middle of its points in the keyframe, x to the right, y up, in the run's unit
};

struct ExchangeChannel {
  std::string name;
  std::size_t node = 0;                         // index into ExchangeRun::nodes
  double direction_x = 1.0, direction_y = 0.0;  // unit vector of the axis, y up
  double delay_s = 0.0;                         // seen this long after the time of its sample
};

struct ExchangeMode {
  double frequency_hz = 0.0;
  std::optional<double> frequency_std_hz;
  double damping_ratio = 0.0;
  std::optional<double> damping_std;
  std::vector<std::complex<double>> shape;  // per channel; NaN = unknown
  std::vector<double> shape_std;            // empty = unknown
  double mpc = 0.0;
  std::string verdict;
};

// A function of two channels: a spectral density (i == j: power) or a correlation.
struct ExchangePair {
  std::size_t i = 0, j = 0;
  std::vector<std::complex<double>> value;
};

struct ExchangeRun {
  std::string name;         // of the run's folder
  std::string unit = "mm";  // of displacements and places: mm or px
  std::vector<ExchangeNode> nodes;
  std::vector<ExchangeChannel> channels;
  std::vector<std::size_t> line;  // nodes in the order of a line drawn through them
  std::vector<ExchangeMode> modes;

  // Displacements as measured: one row per frame, NaN = missing. Empty without displacements.csv.
  double rate_hz = 0.0;
  std::vector<double> t_s;
  std::vector<std::vector<double>> value;  // per channel

  // One-sided spectral densities (unit^2/Hz) at k * frequency_step_hz, Welch; correlations (unit^2) at
  // (k - middle) / rate_hz. Empty without displacements.csv.
  double frequency_step_hz = 0.0;
  int segment = 0;
  std::vector<ExchangePair> spectra;
  int most_lag = 0;
  std::vector<ExchangePair> correlations;

  // Frames lie on the even grid k / rate_hz to within a thousandth of a sample.
  [[nodiscard]] bool is_even() const noexcept;
};

}  // namespace drivers
