#include "firmware_app/report/mode_match.h"

#include <algorithm>
#include <cmath>

#include "core/identification/mac.h"

namespace app {
namespace {

constexpr double kNearShare = 0.1;  // of the wanted frequency

std::size_t index_of(const ModalReport& report, const std::string& name) {
  const auto at = std::find(report.channel_names.begin(), report.channel_names.end(), name);
  return static_cast<std::size_t>(at - report.channel_names.begin());
}

// False for an excluded channel, whose component is unknown.
bool is_known_channel(const ModalReport& report, const std::string& name) {
  const std::size_t c = index_of(report, name);
  return c < report.channel_names.size() &&
         (c >= report.estimate.channels.size() || report.estimate.channels[c].takes_part);
}

}  // namespace

std::vector<std::string> common_channels(const ModalReport& a, const ModalReport& b) {
  std::vector<std::string> names;
  for (const std::string& name : a.channel_names) {
    if (is_known_channel(a, name) && is_known_channel(b, name)) names.push_back(name);
  }
  return names;
}

std::vector<std::complex<double>> shape_for(const ModalReport& report, const core::Mode& mode,
                                            const std::vector<std::string>& names) {
  std::vector<std::complex<double>> shape;
  for (const std::string& name : names) {
    const std::size_t index = index_of(report, name);
    shape.push_back(index < mode.shape.size() ? mode.shape[index] : 0.0);
  }
  return shape;
}

ModeMatch find_mode(const ModalReport& report, const core::Mode& wanted, const std::vector<std::string>& names,
                    const std::vector<std::complex<double>>& wanted_shape) {
  ModeMatch best;
  for (const core::Mode& mode : report.estimate.modes) {
    if (!(std::abs(mode.frequency_hz / wanted.frequency_hz - 1.0) <= kNearShare)) continue;
    const double mac = core::mac(shape_for(report, mode, names), wanted_shape);
    if (best.mode == nullptr || mac > best.mac) best = {&mode, mac};
  }
  return best;
}

}  // namespace app
