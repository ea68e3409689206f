#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/planning/hover_time.h"
#include "tools/hovermodal/plan/words.h"

namespace tools {

using core::planning::CameraOption;
using core::planning::HoverPlan;
using core::planning::ModePlan;
using core::planning::Obstacle;
using core::planning::PlanInput;

namespace {

using Text = std::string;

template <class... Args>
void add(Text& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
}

Text head(const PlanInput& input, const HoverPlan& plan) {
  Text out;
  add(out, "scale     {:.4g} mm/px at {:g} m; the structure takes {:.0f} of {:.0f} px{}\n", plan.mm_per_px,
      input.distance_mm * 1e-3, plan.structure_px, plan.room_px, plan.fits ? "" : "  DOES NOT FIT");
  add(out,
      "noise     {:.3g} px a point, {:.3g} independent points a region: {:.3g} mm rms a channel, {:.3g} mm/sqrt(Hz)\n",
      plan.floor.point_sigma_px, plan.floor.independent_points, plan.floor.channel_sigma_mm,
      plan.floor.density_mm_per_sqrt_hz);
  add(out, "readout   the regions span {:.2f} of a frame\n", plan.delay_span_frames);
  add(out,
      "hover     {:.1f} min planned; {:.1f} min bring sigma f <= {:g} % and sigma damping <= {:g} % in every mode\n",
      plan.hover_s / 60.0, plan.needed_s / 60.0, 100.0 * input.relative_sigma_frequency,
      100.0 * input.relative_sigma_damping);
  add(out,
      "spectrum  segments of {} frames, {:.2g} Hz noise bandwidth; least amplitude = 10 dB over the floor there\n\n",
      plan.segment, plan.bandwidth_hz);
  return out;
}

Text fold_words(const ModePlan& mode) {
  if (!mode.place.margin) return to_text(mode.place.outlook);
  return fmt::format("{} {:.2f}", to_text(mode.place.outlook), *mode.place.margin);
}

Text mode_table(const PlanInput& input, const HoverPlan& plan) {
  Text out;
  add(out, "{:>4} {:>9} {:>9} {:>4}  {:<15} {:>8} {:>10} {:>10} {:>8} {:>8} {:>8}\n", "mode", "true Hz", "seen Hz", "n",
      "from delays", "exposure", "least mm", "expect mm", "dB over", "sigma f", "sigma z");
  for (std::size_t i = 0; i < plan.modes.size(); ++i) {
    const ModePlan& mode = plan.modes[i];
    const auto& rms_mm = input.modes[i].rms_mm;
    add(out, "{:4} {:9.3f} {:9.3f} {:4}  {:<15} {:8.3f} {:10.2g} {:>10} {:>8} {:7.2f}% {:7.1f}%\n", i + 1,
        input.modes[i].frequency_hz, mode.place.apparent_hz, mode.place.n, fold_words(mode), mode.exposure_gain,
        mode.least_rms_mm, rms_mm ? fmt::format("{:.2g}", *rms_mm) : "-",
        mode.over_floor_db ? fmt::format("{:.0f}", *mode.over_floor_db) : "-", 100.0 * mode.relative_sigma_frequency,
        100.0 * mode.relative_sigma_damping);
  }
  add(out,
      "     direct: nothing else is seen there; resolved, ambiguous: lead of the true frequency in MPC, 0.3 is asked\n"
      "     least mm: rms that stands 10 dB over the floor; sigma f, sigma z: relative, after the hover\n\n");
  return out;
}

Text option_words(const CameraOption& option) {
  Text out;
  if (option.n_folded > 0) add(out, "{} folded, ", option.n_folded);
  if (option.n_open > 0) add(out, "{} open, ", option.n_open);
  if (option.n_overlaps > 0) add(out, "{} overlapping, ", option.n_overlaps);
  if (option.n_hidden > 0) add(out, "{} hidden, ", option.n_hidden);
  if (out.empty()) out = "all at their own places, ";
  out.resize(out.size() - 2);
  return option.fits ? out : out + "; does not fit";
}

Text option_table(const PlanInput& input, const HoverPlan& plan) {
  Text out, too_fast;
  add(out, "{:>10}  {:<44} {}\n", "fps", "camera as given", "turned by 90 degrees");
  for (std::size_t i = 0; i + 1 < plan.options.size(); i += 2) {
    const CameraOption& held = plan.options[i];
    if (held.obstacle != Obstacle::kNone) {
      add(too_fast, "{}{:g}", too_fast.empty() ? "" : ", ", held.rate_hz);
      continue;
    }
    const char mark = i / 2 == plan.best_option / 2 ? '>' : ' ';
    add(out, "{} {:8.2f}  {:<44} {}\n", mark, held.rate_hz, option_words(held), option_words(plan.options[i + 1]));
  }
  if (!too_fast.empty()) {
    add(out, "{:>10}  a frame is shorter than the readout of {:g} ms or the exposure of {:g} ms: {}\n", "",
        1e3 * std::abs(input.camera.readout_s), 1e3 * input.camera.exposure_s, too_fast);
  }
  return out + "\n";
}

// Lines of at most `width` characters.
Text wrapped(const Text& text, std::size_t width) {
  Text out;
  std::size_t column = 0, at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::size_t length = end - at;
    if (column > 0 && column + 1 + length > width) {
      out += '\n';
      column = 0;
    }
    if (column > 0) out += ' ', ++column;
    out.append(text, at, length);
    column += length;
    at = end + 1;
  }
  return out + '\n';
}

}  // namespace

const char* to_text(core::planning::FoldOutlook outlook) noexcept {
  switch (outlook) {
    case core::planning::FoldOutlook::kDirect:
      return "direct";
    case core::planning::FoldOutlook::kResolved:
      return "resolved";
    case core::planning::FoldOutlook::kAmbiguous:
      return "ambiguous";
    case core::planning::FoldOutlook::kNoDelays:
      return "no delays";
  }
  return "";
}

std::string plan_text(const PlanInput& input, const HoverPlan& plan) {
  return head(input, plan) + mode_table(input, plan) + option_table(input, plan) +
         wrapped(plan_advice(input, plan), 118) + "\n" + plan_yaml(input, plan);
}

}  // namespace tools
