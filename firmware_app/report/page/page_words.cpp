#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "firmware_app/report/page/page_parts.h"

namespace app {

std::string plural(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string modes_sentence(const core::ModalEstimate& estimate) {
  if (estimate.modes.empty()) {
    const std::string why =
        estimate.status == "ok" || estimate.status.empty() ? "no peak passed every test" : estimate.status;
    return fmt::format("No mode of the structure was found: {}.", why);
  }
  const std::vector<core::Mode>& modes = estimate.modes;
  std::string out =
      plural(modes.size(), "mode of the structure was found, at ", "modes of the structure were found, from ");
  out += four_digits_text(modes.front().frequency_hz);
  if (modes.size() > 1) out += " to " + four_digits_text(modes.back().frequency_hz);
  out += " Hz.";
  const auto n_folded = static_cast<std::size_t>(std::count_if(modes.begin(), modes.end(), is_folded));
  if (n_folded > 0) {
    out += fmt::format(
        " {} faster than the camera can follow directly and {} placed by the delays of the image's rows.",
        n_folded == 1 ? "One of them is" : fmt::format("{} of them are", n_folded), n_folded == 1 ? "was" : "were");
  }
  const double cycles = modes.front().frequency_hz * estimate.duration_s;
  if (std::isfinite(cycles)) out += fmt::format(" The slowest was watched through {:.0f} cycles.", std::floor(cycles));
  return out;
}

const core::ModalEstimate& estimate_of(const PictureInputs& inputs) {
  static const core::ModalEstimate kNone;
  return inputs.estimate == nullptr ? kNone : *inputs.estimate;
}

}  // namespace app
