#include "tools/hovermodal/compare/modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/identification/real_shape.h"
#include "firmware_app/report/mode_match.h"

namespace tools {
namespace {

constexpr std::array<PaperMode, 3> kPaperTable1{
    {{1.632, 1.649, 99.99, 1.04}, {5.054, 5.043, 99.86, 0.22}, {8.175, 8.170, 99.67, 0.06}}};

// Least possible scatter for a record of this length: sqrt(zeta / (2 pi f T)), relative.
double least_scatter(const core::Mode& mode, double duration_s) {
  const double waves = 2.0 * std::numbers::pi * mode.frequency_hz * duration_s;
  return mode.damping_ratio > 0.0 && waves > 0.0 ? std::sqrt(mode.damping_ratio / waves) : 0.0;
}

void add_truth(const app::ModalReport& truth, const core::Mode& found, double duration_s, ComparedMode& out) {
  const auto near = std::find_if(truth.estimate.modes.begin(), truth.estimate.modes.end(), [&](const core::Mode& mode) {
    return std::abs(mode.frequency_hz / found.frequency_hz - 1.0) <= 0.1;
  });
  if (near == truth.estimate.modes.end()) return;
  const double error = found.frequency_hz / near->frequency_hz - 1.0;
  out.true_hz = near->frequency_hz;
  out.true_error_percent = 100.0 * error;
  out.true_error_sigmas = error / least_scatter(*near, duration_s);
}

}  // namespace

// Modes are numbered by the truth if given, else by the reference.
std::vector<ComparedMode> compare_modes(const app::ModalReport& result, const app::ModalReport& reference,
                                        const app::ModalReport* truth, bool with_paper) {
  const std::vector<std::string> names = app::common_channels(result, reference);
  std::vector<ComparedMode> all;
  for (const core::Mode& numbered : (truth != nullptr ? *truth : reference).estimate.modes) {
    ComparedMode& out = all.emplace_back();
    out.number = all.size();
    out.is_folded = numbered.frequency_hz > reference.estimate.rate_hz / 2.0;
    const auto true_shape = app::shape_for(truth != nullptr ? *truth : reference, numbered, names);
    const core::Mode* wanted =
        truth != nullptr ? app::find_mode(reference, numbered, names, true_shape).mode : &numbered;
    const app::ModeMatch match = wanted != nullptr
                                     ? app::find_mode(result, *wanted, names, app::shape_for(reference, *wanted, names))
                                     : app::find_mode(result, numbered, names, true_shape);
    if (match.mode != nullptr) out.found_hz = match.mode->frequency_hz;
    if (wanted != nullptr) out.reference_hz = wanted->frequency_hz;
    if (match.mode == nullptr || wanted == nullptr) continue;
    out.error_percent = 100.0 * (match.mode->frequency_hz / wanted->frequency_hz - 1.0);
    out.mac_percent = 100.0 * match.mac;
    out.real_mac_percent =
        100.0 * core::real_mac(app::shape_for(result, *match.mode, names), app::shape_for(reference, *wanted, names));
    if (truth != nullptr) add_truth(*truth, *match.mode, result.estimate.duration_s, out);
    if (with_paper && out.number <= kPaperTable1.size()) out.paper = kPaperTable1[out.number - 1];
  }
  return all;
}

}  // namespace tools
