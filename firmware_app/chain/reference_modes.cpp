#include "firmware_app/chain/reference_modes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/planning/hover_time.h"
#include "drivers/storage/text_file.h"

namespace app {
namespace {

using core::structure::DeclaredFrame;
using core::structure::ReferenceMode;

// The stated one. Where the record was too short to estimate it: the declared share; undeclared, at least what the
// duration allows.
double sigma_hz_of(const core::Mode& mode, double duration_s, const DeclaredFrame& declared) {
  if (mode.frequency_std_hz.value_or(0.0) > 0.0) return *mode.frequency_std_hz;
  const bool is_declared = declared.frequency_sigma != DeclaredFrame{}.frequency_sigma;
  double share = declared.frequency_sigma;
  if (!is_declared && duration_s > 0.0 && mode.damping_ratio > 0.0) {
    share =
        std::max(share, core::planning::relative_frequency_sigma(mode.frequency_hz, mode.damping_ratio, duration_s));
  }
  return share * mode.frequency_hz;
}

}  // namespace

std::vector<std::size_t> floor_channels(const DeclaredFrame& declared, const std::vector<std::string>& channel_names) {
  std::vector<std::size_t> out;
  for (const std::string& floor : declared.floors) {
    const auto found = std::find(channel_names.begin(), channel_names.end(), floor);
    if (found == channel_names.end()) {
      throw std::invalid_argument(
          fmt::format("no channel `{}` (structure.floors); there are: {}", drivers::printable(floor),
                      drivers::printable(fmt::format("{}", fmt::join(channel_names, ", ")), 200)));
    }
    out.push_back(static_cast<std::size_t>(found - channel_names.begin()));
  }
  return out;
}

void normalise(ReferenceMode& mode) {
  double largest = 0.0;
  for (const double component : mode.shape) {
    if (std::abs(component) > std::abs(largest)) largest = component;
  }
  if (largest == 0.0) {
    mode.shape.clear();
    mode.shape_sigma.clear();
    return;
  }
  for (double& component : mode.shape) component /= largest;
  for (double& sigma : mode.shape_sigma) sigma /= std::abs(largest);
}

std::vector<ReferenceMode> reference_modes(const core::ModalEstimate& estimate,
                                           const std::vector<std::string>& channel_names,
                                           const DeclaredFrame& declared) {
  const std::vector<std::size_t> channels = floor_channels(declared, channel_names);
  std::vector<ReferenceMode> out;
  for (const core::Mode& mode : estimate.modes) {
    ReferenceMode reference;
    reference.number = static_cast<int>(out.size()) + 1;
    reference.frequency_hz = mode.frequency_hz;
    reference.sigma_hz = sigma_hz_of(mode, estimate.duration_s, declared);
    reference.damping_ratio = mode.damping_ratio, reference.damping_sigma = mode.damping_std.value_or(0.0);
    for (const std::size_t c : channels) {
      if (c >= mode.shape.size()) break;
      reference.shape.push_back(mode.shape[c].real());
      // At least a tenth of the declared sigma: the component that scales the shape has none of its own.
      const double stated = c < mode.shape_std.size() ? mode.shape_std[c] : declared.shape_sigma;
      reference.shape_sigma.push_back(std::max(stated, 0.1 * declared.shape_sigma));
    }
    normalise(reference);
    out.push_back(std::move(reference));
  }
  return out;
}

}  // namespace app
