#include "core/closure/observation/region_modes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/identification/identifier.h"
#include "core/identification/mac.h"
#include "core/spectrum/welch_cpsd.h"

namespace core::closure {
namespace {

constexpr double kSameMode = 0.05;  // relative difference from the reference's frequency

ClosureMode plain(const core::Mode& mode) {
  ClosureMode out;
  out.frequency_hz = mode.frequency_hz;
  out.damping_ratio = mode.damping_ratio;
  if (mode.frequency_std_hz) out.sigma_percent = 100.0 * *mode.frequency_std_hz / mode.frequency_hz;
  return out;
}

ClosureMode beside(const core::Mode& reference, const std::vector<core::Mode>& found) {
  const core::Mode* nearest = nullptr;
  double least = kSameMode * reference.frequency_hz;
  for (const core::Mode& mode : found) {
    const double off = std::abs(mode.frequency_hz - reference.frequency_hz);
    if (off < least) least = off, nearest = &mode;
  }
  ClosureMode out = nearest != nullptr ? plain(*nearest) : ClosureMode{};
  out.reference_hz = reference.frequency_hz;
  if (nearest == nullptr) return out;
  out.error_percent = 100.0 * (nearest->frequency_hz / reference.frequency_hz - 1.0);
  if (!reference.shape.empty() && reference.shape.size() == nearest->shape.size())
    out.mac = core::mac(reference.shape, nearest->shape);
  return out;
}

}  // namespace

RegionChannels region_channels(const FitView& fit) {
  RegionChannels out;
  for (std::size_t r = 0; r < fit.record.regions.size(); ++r) {
    const Region& region = fit.record.regions[r];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Eigen::Index row = fit.model.row_of_region(2 * r + axis);
      if (row < 0) continue;
      core::ChannelInfo channel;
      channel.region = static_cast<std::uint16_t>(r);
      channel.name = region.name + (!region.both_axes ? "" : axis == 0 ? ".u" : ".v");
      channel.row_delay_s = fit.readout_frames * fit.model.share_of_column(row) / fit.record.rate_hz;
      channel.is_base = region.role == RegionRole::kBase;
      out.info.push_back(std::move(channel));
      out.rows.push_back(row);
    }
  }
  return out;
}

core::ModalEstimate region_modes(const FitView& fit) {
  const RegionChannels all = region_channels(fit);
  if (all.info.empty()) return {};
  core::WelchConfig config;
  config.n_channels = static_cast<int>(all.info.size());
  config.segment = static_cast<int>(std::min<Eigen::Index>(1024, fit.record.n_frames() / 2));
  config.rate_hz = fit.record.rate_hz;
  core::WelchCpsd welch(config);
  std::vector<double> value(all.info.size());
  const std::vector<std::uint8_t> seen(all.info.size(), 1);
  for (Eigen::Index k = 0; k < fit.record.n_frames(); ++k) {
    for (std::size_t c = 0; c < value.size(); ++c) value[c] = fit.model.amplitudes()(all.rows[c], k);
    welch.push(value, seen);
  }
  welch.flush();
  return core::Identifier(core::IdentifierConfig{}, all.info).identify(welch.sums());
}

std::vector<ClosureMode> compared_modes(const std::vector<core::Mode>& found,
                                        const std::vector<core::Mode>& reference) {
  std::vector<ClosureMode> out;
  if (reference.empty()) {
    for (const core::Mode& mode : found) out.push_back(plain(mode));
  }
  for (const core::Mode& mode : reference) out.push_back(beside(mode, found));
  for (std::size_t i = 0; i < out.size(); ++i) out[i].number = static_cast<int>(i) + 1;
  return out;
}

std::optional<double> rms_error_percent(const std::vector<ClosureMode>& modes) {
  double squares = 0.0;
  int n = 0;
  for (const ClosureMode& mode : modes) {
    if (!mode.error_percent) continue;
    squares += *mode.error_percent * *mode.error_percent;
    ++n;
  }
  return n > 0 ? std::optional<double>(std::sqrt(squares / n)) : std::nullopt;
}

}  // namespace core::closure
