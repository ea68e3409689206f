#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/planning/hover_time.h"
#include "tools/hovermodal/plan/words.h"

namespace tools {

using core::planning::CameraOption;
using core::planning::FoldOutlook;
using core::planning::HoverPlan;
using core::planning::ModePlan;
using core::planning::PlanInput;

namespace {

using Text = std::string;
using Indices = std::vector<std::size_t>;

Indices modes_where(const HoverPlan& plan, const std::function<bool(const ModePlan&)>& holds) {
  Indices out;
  for (std::size_t i = 0; i < plan.modes.size(); ++i) {
    if (holds(plan.modes[i])) out.push_back(i);
  }
  return out;
}

Text places(const HoverPlan& plan, const Indices& indices) {
  Text out;
  for (const std::size_t i : indices)
    out += fmt::format("{}{:.2f}", out.empty() ? "" : ", ", plan.modes[i].place.apparent_hz);
  return out + " Hz";
}

Text view_words(const PlanInput& input, const HoverPlan& plan) {
  if (plan.fits) {
    return fmt::format("From {:g} m one pixel is {:.3g} mm and a channel's noise {:.2g} mm rms.",
                       input.distance_mm * 1e-3, plan.mm_per_px, plan.floor.channel_sigma_mm);
  }
  const double least_m = 1e-3 * input.length_mm * input.camera.focal_px / (0.9 * plan.room_px);
  return fmt::format(
      "The structure does not fit: it needs {:.0f} px and the image has {:.0f} in that direction, "
      "a tenth of it reserved for drift; keep {:.3g} m or more distance, use a shorter lens{}.",
      plan.structure_px, plan.room_px, least_m, plan.options[1].fits ? ", or rotate the camera" : "");
}

Text fold_words(const PlanInput& input, const HoverPlan& plan) {
  const Indices folded = modes_where(plan, [](const ModePlan& m) { return m.place.n != 0; });
  const Indices open = modes_where(plan, [](const ModePlan& m) {
    return m.place.outlook == FoldOutlook::kAmbiguous || m.place.outlook == FoldOutlook::kNoDelays;
  });
  Text out;
  if (!folded.empty()) {
    out += fmt::format(" {} lie{} above half of {:g} fps and will appear at {}.", mode_list(folded),
                       folded.size() == 1 ? "s" : "", input.camera.rate_hz, places(plan, folded));
    out[1] = 'M';
  }
  if (!open.empty()) {
    const bool none = plan.modes[open.front()].place.outlook == FoldOutlook::kNoDelays;
    out += fmt::format(" Whether {} lie{} below or above half the frame rate stays open: {}.", mode_list(open),
                       open.size() == 1 ? "s" : "",
                       none ? "the regions are all read at nearly the same time, or there are fewer than three"
                            : "the delays between the rows differ too little for that shape");
  } else if (!folded.empty()) {
    out +=
        " The delays between the rows determine that they do: set identification.max_frequency_hz as "
        "below.";
  }
  return out;
}

Text overlap_words(const HoverPlan& plan) {
  Text out;
  for (const auto& overlap : plan.overlaps) {
    out += fmt::format(" Of {} the places lie {:.2g} Hz apart, {} their width of {:.2g} Hz: {}.",
                       mode_list({overlap.first, overlap.second}), overlap.gap_hz,
                       overlap.merges ? "less than half" : "less than", overlap.width_hz,
                       overlap.merges ? "expect one of them to be lost or false"
                                      : "only a long record and their shapes separate them");
  }
  const Indices edge = modes_where(plan, [](const ModePlan& m) { return m.edge && !m.in_hover_band; });
  if (!edge.empty())
    out += fmt::format(" At the edge of the spectrum {} overlap{} with the mirror image.", mode_list(edge),
                       edge.size() == 1 ? "s" : "");
  return out;
}

// Rotating the camera would separate the alias orders if the structure stayed in view.
Text turning_words(const PlanInput& input, const HoverPlan& plan) {
  const CameraOption& turned = plan.options[1];
  const CameraOption& best = plan.options[plan.best_option];
  if (best.n_open == 0 || turned.n_open >= best.n_open || turned.fits) return {};
  const double room = core::planning::room_px(core::planning::turned(input.camera), input.axis);
  return fmt::format(
      " With the camera rotated by 90 degrees the row delays would determine more; the structure "
      "then fits from {:.3g} m on.",
      1e-3 * input.length_mm * input.camera.focal_px / (0.9 * room));
}

Text option_words(const PlanInput& input, const HoverPlan& plan) {
  const CameraOption& best = plan.options[plan.best_option];
  const CameraOption& given = plan.options.front();
  if (plan.best_option == 0) {
    return given.penalty == 0.0 ? " The camera may stay as it is."
                                : " No other frame rate of the list, and no rotation of the camera, is better.";
  }
  Text out = " Better:";
  if (best.rate_hz != given.rate_hz) out += fmt::format(" fly with {:g} fps", best.rate_hz);
  if (best.turned) {
    out += fmt::format("{} rotate the camera by 90 degrees, so that its lines are read {} the structure",
                       best.rate_hz != given.rate_hz ? " and" : "",
                       core::planning::reads_along(input.camera, input.axis) ? "across" : "along");
  }
  const auto count = [](int n, const char* what) { return fmt::format("{} {}", n, what); };
  out += fmt::format(" (then {}, {}, {}, where it was {}, {}, {}).", count(best.n_folded, "folded"),
                     count(best.n_open, "open"), count(best.n_overlaps, "overlapping"), count(given.n_folded, "folded"),
                     count(given.n_open, "open"), count(given.n_overlaps, "overlapping"));
  if (best.rate_hz != given.rate_hz && input.camera.readout_s != 0.0)
    out += " Check that the readout time is the same there.";
  return out;
}

Text amplitude_words(const HoverPlan& plan) {
  Text out;
  const Indices blurred =
      modes_where(plan, [](const ModePlan& m) { return m.exposure_gain < core::planning::kLeastExposureGain; });
  if (!blurred.empty()) {
    out += fmt::format(" The exposure leaves less than {:g} of {}: expose for a shorter time.",
                       core::planning::kLeastExposureGain, mode_list(blurred));
  }
  const Indices faint = modes_where(plan, [](const ModePlan& m) { return m.over_floor_db && *m.over_floor_db < 10.0; });
  if (!faint.empty()) {
    const auto worst = std::min_element(faint.begin(), faint.end(), [&](std::size_t a, std::size_t b) {
      return *plan.modes[a].over_floor_db < *plan.modes[b].over_floor_db;
    });
    const double factor = std::pow(10.0, (10.0 - *plan.modes[*worst].over_floor_db) / 20.0);
    out += fmt::format(
        " With the expected amplitude {} {} less than 10 dB over the noise floor: go closer or use a "
        "longer lens ({:.2g} times), mark larger regions with more points, or put targets on the "
        "structure.",
        mode_list(faint), faint.size() == 1 ? "stands" : "stand", factor);
  }
  return out;
}

Text time_words(const PlanInput& input, const HoverPlan& plan) {
  std::size_t longest = 0;
  const auto need = [&](std::size_t i) {
    return std::max(plan.modes[i].seconds_for_frequency, plan.modes[i].seconds_for_damping);
  };
  for (std::size_t i = 1; i < plan.modes.size(); ++i) longest = need(i) > need(longest) ? i : longest;
  const bool damping = plan.modes[longest].seconds_for_damping >= plan.modes[longest].seconds_for_frequency;
  Text out = fmt::format(
      " Hover {:.1f} min for the wanted standard deviations ({} of mode {} needs most; frequencies alone {:.1f} min).",
      plan.needed_s / 60.0, damping ? "damping" : "frequency", longest + 1,
      std::ranges::max_element(plan.modes, {}, &ModePlan::seconds_for_frequency)->seconds_for_frequency / 60.0);
  if (input.battery_s > 0.0 && plan.needed_s > input.battery_s) {
    const auto& mode = input.modes[longest];
    const double f_sigma =
        core::planning::relative_frequency_sigma(mode.frequency_hz, mode.damping_ratio, input.battery_s);
    const double damping_sigma =
        core::planning::relative_damping_sigma(mode.frequency_hz, mode.damping_ratio, input.battery_s);
    out += fmt::format(
        " One battery gives {:.1f} min: {:.0f} flights, or sigma f {:.2g} %, sigma damping {:.2g} % in mode {} after "
        "one.",
        input.battery_s / 60.0, std::ceil(plan.needed_s / input.battery_s), 100.0 * f_sigma, 100.0 * damping_sigma,
        longest + 1);
  } else if (input.battery_s > 0.0) {
    out += fmt::format(" One battery of {:.3g} min is enough.", input.battery_s / 60.0);
  }
  return out;
}

Text drift_words(const HoverPlan& plan) {
  const Indices low = modes_where(plan, [](const ModePlan& m) { return m.in_hover_band; });
  if (low.empty())
    return " Mark a region of role base at the foot, to distinguish modes from motion of the ground and "
           "the camera.";
  return fmt::format(
      " Below {:g} Hz, where {} {} seen, the picture moves with the hovering camera: mark a base region at the foot "
      "and a "
      "background region that cannot move, near the structure and as far away as it is, so that the camera's own "
      "motion is on record; film from a tripod where that is possible.",
      core::planning::kHoverBandHz, mode_list(low), low.size() == 1 ? "is" : "are");
}

}  // namespace

std::string mode_list(const Indices& indices) {
  Text out = indices.size() == 1 ? "mode " : "modes ";
  for (std::size_t k = 0; k < indices.size(); ++k) {
    if (k > 0) out += k + 1 == indices.size() ? " and " : ", ";
    out += fmt::format("{}", indices[k] + 1);
  }
  return out;
}

std::string plan_advice(const PlanInput& input, const HoverPlan& plan) {
  return view_words(input, plan) + fold_words(input, plan) + overlap_words(plan) + option_words(input, plan) +
         turning_words(input, plan) + amplitude_words(plan) + time_words(input, plan) + drift_words(plan);
}

}  // namespace tools
