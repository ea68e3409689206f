#pragma once

namespace core::planning {

// Standard deviation of this identification over the lower bound of any method for a record of this length, measured on
// simulated records: 1.0 to 1.3.
inline constexpr double kMethodFactor = 1.2;

// sigma_f / f = 1.2 sqrt(zeta / (2 pi f T)) and sigma_zeta / zeta = 1.2 / sqrt(2 pi zeta f T), T in seconds.
[[nodiscard]] double relative_frequency_sigma(double frequency_hz, double damping_ratio, double duration_s) noexcept;
[[nodiscard]] double relative_damping_sigma(double frequency_hz, double damping_ratio, double duration_s) noexcept;

// The same equations solved for T.
[[nodiscard]] double seconds_for_frequency(double frequency_hz, double damping_ratio, double relative_sigma) noexcept;
[[nodiscard]] double seconds_for_damping(double frequency_hz, double damping_ratio, double relative_sigma) noexcept;

// Welch segment: a power of two that contains two time constants 1 / (zeta w) of the slowest mode, with at least four
// lengths (seven half-overlapping ones) in the record.
[[nodiscard]] int segment_length(double slowest_hz, double damping_ratio, double rate_hz, double duration_s) noexcept;

// Equivalent noise bandwidth of a Hann window.
[[nodiscard]] inline double hann_bandwidth_hz(int segment, double rate_hz) noexcept { return 1.5 * rate_hz / segment; }

}  // namespace core::planning
