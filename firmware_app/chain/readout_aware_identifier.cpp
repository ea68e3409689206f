#include "firmware_app/chain/readout_aware_identifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/channel_displacement.h"
#include "core/identification/readout_choice.h"
#include "core/identification/readout_from_shapes.h"
#include "firmware_app/config/core_config.h"

namespace app {

namespace {

constexpr double kChosenSigma_s = 1e-3, kUndeclaredSigma_frames = 0.5;
constexpr double kNoticeable_frames = 0.005;  // of the readout; less changes shapes by less than their scatter
// Poles that may be used to estimate the readout time.
constexpr double kLeastPresence = 0.85, kMostDamping = 0.05, kLeastMpc = 0.9;
constexpr int kLeastPoles = 3;
constexpr double kLeastBlocks = 2.0;  // of a codec along the readout, within a region whose shear is used

core::ReadoutValue declared_readout(const AppConfig& config, const core::CameraInfo& camera) {
  const double sigma_ms = config.camera.readout_sigma_ms;
  core::ReadoutValue declared{1e-9 * static_cast<double>(camera.readout_ns), 1e-3 * sigma_ms};
  if (sigma_ms < 0.0)
    declared.std_s = camera.readout_ns != 0 ? kChosenSigma_s : kUndeclaredSigma_frames / camera.rate_hz;
  return declared;
}

// Row delays for a readout time of one second.
std::vector<double> row_shares(const AppConfig& config, const core::CameraInfo& camera,
                               const core::TrackFrame& keyframe) {
  core::ChannelDisplacementConfig unit = displacement_config(config, camera);
  unit.readout.readout_s = 1.0;
  std::vector<double> shares;
  const core::ChannelDisplacement displacement(unit, keyframe);
  for (const core::ChannelInfo& channel : displacement.spectra()) shares.push_back(channel.row_delay_s);
  return shares;
}

bool can_be_read(const core::Mode& mode) {
  return mode.presence >= kLeastPresence && mode.damping_ratio > 0.0 && mode.damping_ratio < kMostDamping &&
         mode.verdict != core::Verdict::kCameraMotion && mode.verdict != core::Verdict::kHarmonic &&
         mode.verdict != core::Verdict::kInputPeak;
}

}  // namespace

core::ReadoutEstimator::Config readout_config(const AppConfig& config, const core::CameraInfo& camera) {
  const core::ChannelDisplacementConfig displacement = displacement_config(config, camera);
  return {{config.regions.size(), displacement.camera, displacement.readout, {}, kLeastBlocks * camera.coding_block_px},
          camera.rate_hz};
}

ReadoutAwareIdentifier::ReadoutAwareIdentifier(const AppConfig& config, const core::CameraInfo& camera,
                                               const core::TrackFrame& keyframe, std::vector<core::ChannelInfo> spectra)
    : ReadoutAwareIdentifier({identifier_config(config, spectra, camera.rate_hz), row_shares(config, camera, keyframe),
                              camera.rate_hz, declared_readout(config, camera)},
                             spectra) {}

ReadoutAwareIdentifier::ReadoutAwareIdentifier(ReadoutBasis basis, std::vector<core::ChannelInfo> spectra)
    : basis_(std::move(basis)),
      channels_(std::move(spectra)),
      n_outputs_(core::Identifier(basis_.identifier, channels_).n_outputs()) {}

ReadoutAwareIdentifier::ReadoutAwareIdentifier(const AppConfig& config, double rate_hz,
                                               const std::vector<core::ChannelInfo>& spectra)
    : ReadoutAwareIdentifier(ReadoutBasis{identifier_config(config, spectra, rate_hz), {}, rate_hz, {}}, spectra) {}

std::vector<core::ChannelInfo> ReadoutAwareIdentifier::channels_with(double readout_s) const {
  std::vector<core::ChannelInfo> channels = channels_;
  for (std::size_t c = 0; c < basis_.row_share.size(); ++c) channels[c].row_delay_s = readout_s * basis_.row_share[c];
  return channels;
}

std::vector<double> ReadoutAwareIdentifier::delay_s(const core::ModalEstimate& estimate) const {
  const double readout_s = estimate.readout ? estimate.readout->used.readout_s : basis_.declared.readout_s;
  return core::Identifier(basis_.identifier, channels_with(readout_s)).undone_delay_s();
}

std::optional<core::ReadoutValue> ReadoutAwareIdentifier::read_shapes(const core::ModalEstimate& estimate,
                                                                      double readout_s) const {
  const std::vector<core::ChannelInfo> channels = channels_with(readout_s);
  std::vector<core::ObservedPole> poles;
  for (const auto* list : {&estimate.modes, &estimate.rejected}) {
    for (const core::Mode& mode : *list) {
      if (can_be_read(mode)) poles.push_back(core::observed_pole(mode, channels, basis_.rate_hz));
    }
  }
  const auto read = core::readout_from_shapes(poles, {basis_.row_share.data(), n_outputs_},
                                              {basis_.rate_hz, basis_.identifier.max_frequency_hz, 1.0});
  if (!read || !read->scatter_known || read->n_poles < kLeastPoles || read->mean_mpc < kLeastMpc) return {};
  return core::ReadoutValue{read->readout_frames / basis_.rate_hz, read->std_frames / basis_.rate_hz};
}

core::ModalEstimate ReadoutAwareIdentifier::identify(const core::CpsdSums& sums,
                                                     const core::ReadoutEstimate& from_tracks) const {
  if (!basis_.identifier.undo_row_delays || basis_.row_share.empty())
    return core::Identifier(basis_.identifier, channels_).identify(sums);
  std::optional<core::ReadoutValue> tracks;
  if (from_tracks.observable)
    tracks = core::ReadoutValue{from_tracks.frames / basis_.rate_hz, from_tracks.std_frames / basis_.rate_hz};
  core::ReadoutFinding finding = core::choose_readout(basis_.declared, tracks, {});
  const double first_s = finding.used.readout_s;
  core::ModalEstimate estimate = core::Identifier(basis_.identifier, channels_with(first_s)).identify(sums);
  if (const auto shapes = read_shapes(estimate, first_s)) {
    finding = core::choose_readout(basis_.declared, tracks, shapes);
    if (std::abs(finding.used.readout_s - first_s) * basis_.rate_hz > kNoticeable_frames) {
      estimate = core::Identifier(basis_.identifier, channels_with(finding.used.readout_s)).identify(sums);
    } else {
      finding.used.readout_s = first_s;
    }
  }
  estimate.readout = std::move(finding);
  return estimate;
}

}  // namespace app
