#pragma once

#include <vector>

#include "core/geometry/readout_estimator.h"
#include "core/identification/identifier.h"
#include "core/types/displacement.h"
#include "core/types/frame.h"
#include "core/types/modal_estimate.h"
#include "core/types/readout.h"
#include "core/types/track.h"
#include "firmware_app/config/config.h"

namespace app {

[[nodiscard]] core::ReadoutEstimator::Config readout_config(const AppConfig& config, const core::CameraInfo& camera);

// Inputs of an identification with the readout time, besides the channels: plain values, kept together with the sums.
struct ReadoutBasis {
  core::IdentifierConfig identifier;
  std::vector<double>
      row_share;  // share of the readout that has passed when each channel is seen; empty: see ReadoutAwareIdentifier
  double rate_hz = 0.0;
  core::ReadoutValue declared;
};

// Identification with the best known readout time. It combines the declared one with camera.readout_sigma_ms (default:
// 1 ms, or half a frame where nothing is declared), the one estimated from the tracks, and the one estimated from the
// mode shapes. Where the last changes it noticeably, the modes are identified once more with the new value. In paper
// mode row delays are neither corrected nor estimated. For channels without an image (basis.row_share empty), the row
// delays that they state are corrected, none estimated. A pure function of its arguments: a replay gives the same bits.
// Any thread.
class ReadoutAwareIdentifier {
 public:
  // Throws as identifier_config() does.
  ReadoutAwareIdentifier(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe,
                         std::vector<core::ChannelInfo> spectra);
  ReadoutAwareIdentifier(ReadoutBasis basis, std::vector<core::ChannelInfo> spectra);
  // Channels without an image. Throws as identifier_config() does.
  ReadoutAwareIdentifier(const AppConfig& config, double rate_hz, const std::vector<core::ChannelInfo>& spectra);

  [[nodiscard]] core::ModalEstimate identify(const core::CpsdSums& sums,
                                             const core::ReadoutEstimate& from_tracks) const;

  // Row delay of every channel as corrected in the estimate's shapes, or as it would be if declared; 0 in paper mode.
  [[nodiscard]] std::vector<double> delay_s(const core::ModalEstimate& estimate) const;
  [[nodiscard]] int n_outputs() const noexcept { return static_cast<int>(n_outputs_); }
  [[nodiscard]] std::vector<double> declared_delay_s() const { return delay_s({}); }
  [[nodiscard]] const ReadoutBasis& basis() const noexcept { return basis_; }
  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept { return channels_; }

 private:
  [[nodiscard]] std::vector<core::ChannelInfo> channels_with(double readout_s) const;
  [[nodiscard]] std::optional<core::ReadoutValue> read_shapes(const core::ModalEstimate& estimate,
                                                              double readout_s) const;

  ReadoutBasis basis_;
  std::vector<core::ChannelInfo> channels_;
  std::size_t n_outputs_;  // channels without the witnesses
};

}  // namespace app
