#include "core/identification/camera_lines.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/identification/mac.h"
#include "core/identification/spectral_peaks.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {

constexpr double kCoarsest_hz = 0.25;  // resolution
constexpr double kFewestSegments = 4;  // a hover's own spectrum is uneven over less

// "134.0 Hz or 91.0 Hz"; empty: open.
std::string true_frequencies(const CameraLine& line) {
  std::string out;
  for (const double hz : line.true_hz) out += in_words(out.empty() ? "%.1f Hz" : " or %.1f Hz", std::abs(hz));
  return out;
}

std::string line_reason(const CameraLine& line) {
  const std::string seen =
      line.of_the_region
          ? in_words("a static region moves at %.2f Hz, %.2g times the spectrum beside it", line.apparent_hz,
                     line.height)
          : in_words("seen at %.2f Hz, %.2g times the spectrum beside it", line.apparent_hz, line.height);
  if (line.true_hz.empty()) return "vibration of the camera: " + seen + "; its true frequency is open";
  return "vibration of the camera at " + true_frequencies(line) + " by the rows' phases: " + seen;
}

Mode line_pole(const CameraLine& line, double rate_hz) {
  Mode pole;
  pole.apparent_hz = pole.frequency_hz = line.apparent_hz;
  if (!line.true_hz.empty()) {
    pole.frequency_hz = std::abs(line.true_hz.front());
    pole.fold_n = static_cast<int>(std::lround((line.true_hz.front() - line.apparent_hz) / rate_hz));
    pole.fold_margin = line.margin;
  }
  pole.shape = line.motion;
  const auto largest = std::max_element(pole.shape.begin(), pole.shape.end(),
                                        [](const auto& a, const auto& b) { return std::norm(a) < std::norm(b); });
  if (largest != pole.shape.end() && std::norm(*largest) > 0.0) {
    const std::complex<double> scale = *largest;
    for (auto& component : pole.shape) component /= scale;
  }
  pole.mpc = mpc(pole.shape);
  pole.presence = 1.0;
  set(pole, Verdict::kCameraMotion, line_reason(line));
  return pole;
}

// Apparent frequencies of all poles that the structure or its input explains.
std::vector<double> frequencies_of_structure(const ModalEstimate& estimate) {
  std::vector<double> out;
  for (const Mode& mode : estimate.modes) out.push_back(mode.apparent_hz);
  for (const Mode& pole : estimate.rejected) {
    if (pole.verdict != Verdict::kCameraMotion && pole.verdict != Verdict::kNumerical) out.push_back(pole.apparent_hz);
  }
  return out;
}

// The pole of the camera that is listed there; null: none.
Mode* listed_pole(const CameraLine& line, std::vector<Mode>& poles) {
  const auto pole = std::find_if(poles.begin(), poles.end(), [&](const Mode& one) {
    return one.verdict == Verdict::kCameraMotion && std::abs(one.apparent_hz - line.apparent_hz) < line.half_width_hz;
  });
  return pole != poles.end() ? &*pole : nullptr;
}

}  // namespace

void list_camera_lines(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, const FoldingConfig& folding,
                       ModalEstimate& estimate) {
  const double resolved_hz = resolution_hz(sums);
  if (sums.data_sum.empty() || sums.weight.effective() < kFewestSegments) return;
  if (!(resolved_hz > 0.0 && resolved_hz <= kCoarsest_hz)) return;
  std::vector<CameraLine> found = lines_of_static_regions(sums, channels, folding);
  const auto by_height = [](const CameraLine& a, const CameraLine& b) { return a.height > b.height; };
  std::stable_sort(found.begin(), found.end(), by_height);
  for (CameraLine& line : lines_by_row_phases(sums, channels, folding, frequencies_of_structure(estimate)))
    found.push_back(std::move(line));
  std::size_t n_listed = 0;
  for (const CameraLine& line : found) {
    if (Mode* const pole = listed_pole(line, estimate.rejected)) {
      const bool states_it = pole->reason.starts_with("vibration of the camera");
      if (!states_it && !line.true_hz.empty())
        pole->reason += "; by the rows' phases it vibrates at " + true_frequencies(line);
    } else if (n_listed < kMostCameraLines) {
      estimate.rejected.push_back(line_pole(line, sums.rate_hz));
      ++n_listed;
    }
  }
}

}  // namespace core
