#include "firmware_app/report/recording_words.h"

#include <fmt/format.h>

namespace app {
namespace {

std::string milliseconds(double t_s) { return fmt::format("{:.3g} ms", 1e3 * t_s); }

std::string are(std::uint64_t n) { return fmt::format("{} {}", n, n == 1 ? "frame is" : "frames are"); }

std::string spacing(const core::RecordingTimes& times) {
  std::string out = fmt::format("Frames lie 1/{:.6g} s apart by {}", times.rate_hz, times.from);
  constexpr double kEven = 0.01;  // of a period: less is attributed to rounding of the times
  if (times.worst_s * times.rate_hz < kEven) return out + ", evenly.";
  return out +
         fmt::format(", unevenly: {} rms, {} at worst.", milliseconds(times.jitter_s), milliseconds(times.worst_s));
}

}  // namespace

std::string recording_words(const core::RecordingTimes& times) {
  if (!times.known()) return {};
  std::string out = spacing(times);
  if (times.n_lost == 0) {
    out += fmt::format(" None of its {} frames is missing in the file.", times.n_frames);
  } else {
    out += fmt::format(" {} missing in the file beside its {}, in {} {}, the longest {:.3g} s.", are(times.n_lost),
                       times.n_frames, times.n_gaps, times.n_gaps == 1 ? "gap" : "gaps", times.longest_gap_s);
  }
  if (times.n_repeated > 0) out += fmt::format(" {} left out that repeat the one before.", are(times.n_repeated));
  if (times.n_damaged > 0) out += fmt::format(" {} damaged and left out.", are(times.n_damaged));
  if (times.n_after_damage > 0)
    out += fmt::format(" {} predicted from a damaged one and may be wrong.", are(times.n_after_damage));
  if (!times.remark.empty()) out += " " + times.remark + ".";
  return out;
}

}  // namespace app
