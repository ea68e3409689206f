#pragma once

namespace core::closure {

// Materiality thresholds of the observation level: smallest gain per residual value, in noise variances. The model's
// own errors stay below them (core/closure/METHOD.md).
inline constexpr double kFullBandBar = 0.02;  // one amplitude per frame, and latent patterns
inline constexpr double kLowBandBar = 0.005;  // the same, up to PointMotionModel::kLowBand_hz
inline constexpr double kGlobalBar = 0.003;   // constants of the record, spectral lines

}  // namespace core::closure
