#include "tools/hovermodal/modes_text.h"

#include <fmt/core.h>

namespace tools {

std::string modes_text(const core::ModalEstimate& estimate, const std::vector<core::ChannelInfo>& channels) {
  std::string text =
      fmt::format("{} modes from {:.1f} s, {} segments, order {}{}\n", estimate.modes.size(), estimate.duration_s,
                  estimate.n_segments, estimate.model_order, estimate.status == "ok" ? "" : ": " + estimate.status);
  for (const core::Mode& mode : estimate.modes) {
    text += fmt::format("  {:9.4f} Hz  damping {:5.2f} %  MPC {:.3f} ", mode.frequency_hz, 100.0 * mode.damping_ratio,
                        mode.mpc);
    for (std::size_t c = 0; c < channels.size() && c < mode.shape.size(); ++c) {
      text += fmt::format(" {} {:+.3f}", channels[c].name, mode.shape[c].real());
    }
    if (mode.fold_n.value_or(0) != 0)
      text += fmt::format("  (seen at {:.4f} Hz, margin {:.2f})", mode.apparent_hz, mode.fold_margin.value_or(0.0));
    text += '\n';
  }
  for (const core::Mode& mode : estimate.rejected) {
    text += fmt::format("  {:9.4f} Hz  {}: {}\n", mode.frequency_hz, core::to_string(mode.verdict), mode.reason);
  }
  return text;
}

}  // namespace tools
