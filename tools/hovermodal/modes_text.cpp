#include "tools/hovermodal/modes_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "firmware_app/report/estimate_words.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

// " ± 0.0046", or nothing where the standard deviation is unknown.
std::string sigma_text(const std::optional<double>& sigma, double factor, int n_decimals) {
  return sigma ? fmt::format(" ± {:.{}f}", factor * *sigma, n_decimals) : std::string();
}

// " NAME VALUE" of every channel; of many channels the first ones.
template <class Value>
std::string by_channel(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels,
                       std::size_t n_values, const Value& value) {
  constexpr std::size_t kMostListed = 24;
  std::string text;
  for (std::size_t c = 0; c < std::min({channels.size(), n_values, kMostListed}); ++c) {
    const bool known = c >= estimate.channels.size() || estimate.channels[c].takes_part;
    text += fmt::format(" {} {}", channels[c].name, known ? value(c) : "unknown");
  }
  if (channels.size() > kMostListed) text += fmt::format(" ... ({} channels, all in --json)", channels.size());
  return text;
}

}  // namespace

std::string modes_text(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels) {
  std::string text =
      fmt::format("{} modes from {:.1f} s, {} segments, order {}{}\n", estimate.modes.size(), estimate.duration_s,
                  estimate.n_segments, estimate.model_order, estimate.status == "ok" ? "" : ": " + estimate.status);
  for (const core::Mode& mode : estimate.modes) {
    text += fmt::format("  {:9.4f}{} Hz  damping {:5.2f}{} %  MPC {:.3f} ", mode.frequency_hz,
                        sigma_text(mode.frequency_std_hz, 1.0, 4), 100.0 * mode.damping_ratio,
                        sigma_text(mode.damping_std, 100.0, 2), mode.mpc);
    text += by_channel(estimate, channels, mode.shape.size(),
                       [&](std::size_t c) { return fmt::format("{:+.3f}", mode.shape[c].real()); });
    if (mode.fold_n.value_or(0) != 0)
      text += fmt::format("  (seen at {:.4f} Hz, margin {:.2f})", mode.apparent_hz, mode.fold_margin.value_or(0.0));
    if (const std::string others = app::other_frequencies_text(mode); !others.empty())
      text += fmt::format("  (aliases not excluded{})", others);
    text += '\n';
  }
  for (const core::Mode& mode : estimate.rejected) {
    text += fmt::format("  {:9.4f} Hz  {}: {}\n", mode.frequency_hz, core::to_string(mode.verdict), mode.reason);
  }
  if (!estimate.peaks.empty()) text += "peaks of the spectra, without a verdict:\n";
  for (const core::SpectralPeak& peak : estimate.peaks) {
    text +=
        fmt::format("  {:9.4f} Hz  to {:.2g} Hz, height {:.0f} ", peak.frequency_hz, peak.resolution_hz, peak.height);
    text += by_channel(estimate, channels, peak.share.size(),
                       [&](std::size_t c) { return fmt::format("{:.2f}", peak.share[c]); });
    text += '\n';
  }
  for (const std::string& words : app::estimate_words(estimate, channels)) text += "note: " + words + "\n";
  return text;
}

std::string modes_json(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels,
                       const std::string& method) {
  app::ModalReport report;
  report.method = method;
  for (const core::ChannelInfo& channel : channels) report.channel_names.push_back(channel.name);
  report.estimate = estimate;
  return app::modal_json(report);
}

}  // namespace tools
