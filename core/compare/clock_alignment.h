#pragma once

#include <optional>

#include "core/compare/band_limited.h"
#include "core/types/frame_prediction.h"

namespace core {

// Time of the sensor's clock at camera time t: t + offset_s + rate * (t - middle_s).
struct ClockRelation {
  double middle_s = 0.0;  // middle of what both records share, on the camera's clock
  double offset_s = 0.0, offset_std_s = 0.0;
  double rate = 0.0, rate_std = 0.0;  // relative; 1e-6 = 1 ppm
  [[nodiscard]] double sensor_s(double camera_s) const noexcept {
    return camera_s + offset_s + rate * (camera_s - middle_s);
  }
};

// Another offset that the records do not exclude.
struct RivalOffset {
  double offset_s = 0.0;
  double evidence = 0.0;  // log-likelihood below the best
};

struct ClockSearch {
  double most_offset_s = 0.0;  // |offset| searched; 0 = as far as the records overlap by half of the shorter one
};

// What a video codec does to motion (METHOD.md, 2): with frames predicted from earlier ones a share of the motion since
// the last frame is left out or counted twice, which delays or advances a motion by an amount that depends on its
// frequency; with frames predicted from both sides little of that is left.
struct VideoFrames {
  double interval_s = 0.0;  // between frames
  FramePrediction prediction = FramePrediction::kUnknown;

  [[nodiscard]] bool share_motion() const noexcept {
    return interval_s > 0.0 && (prediction == FramePrediction::kPast || prediction == FramePrediction::kBoth);
  }
  // Standard deviation of the share before the fit: its rms in coded clips of known motion.
  [[nodiscard]] double share_std() const noexcept { return prediction == FramePrediction::kPast ? 0.05 : 0.02; }
};

struct ClockAlignment {
  bool found = false;     // false: no correlation above chance; the rest is not set
  double evidence = 0.0;  // log-likelihood ratio of the best offset to none
  double chance = 0.0;    // which chance reaches in as many trials, once in 150
  ClockRelation clock;
  double ratio = 1.0, ratio_std = 0.0;              // amplitude camera / sensor, by least squares; < 0: opposite signs
  double frame_share = 0.0, frame_share_std = 0.0;  // of the codec, see VideoFrames; 0 without
  std::optional<RivalOffset> rival;                 // within 8 of the best
  double from_s = 0.0, to_s = 0.0;                  // camera times that were used
};

// Candidate offsets by cross-correlation, the best after a fit of each; then offset, rate and amplitude ratio together
// by least squares over growing stretches, so that a clock error of many periods over a long record is followed
// (METHOD.md, 2). The camera's samples are at k / camera_rate_hz. Standard deviations from blocks of the record, valid
// for coloured residuals.
[[nodiscard]] ClockAlignment align_clocks(const BandLimited& camera, double camera_rate_hz, const BandLimited& sensor,
                                          const Band& band, const ClockSearch& search = {});

// Only the fit, from a known relation: where another band has told the offset already.
// `start` states the shared stretch (from_s, to_s, middle_s) and where the fit begins. With `frames` the codec's share
// of the motion since the last frame is estimated as well.
[[nodiscard]] ClockAlignment refine_clocks(const BandLimited& camera, double camera_rate_hz, const BandLimited& sensor,
                                           const Band& band, const ClockAlignment& start,
                                           const VideoFrames& frames = {});

// Whether an instant of the camera counts: both records seen there, and a period of the lower limit away from all ends.
[[nodiscard]] bool counts(const BandLimited& camera, const BandLimited& sensor, const Band& band,
                          const ClockRelation& clock, double camera_s) noexcept;

}  // namespace core
