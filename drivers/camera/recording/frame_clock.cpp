#include "drivers/camera/recording/frame_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "drivers/camera/recording/time_fit.h"
#include "drivers/camera/recording/timestamp_file.h"

namespace drivers {

namespace {

constexpr double kContradicts = 0.02;  // of the rate
constexpr const char* kDeclared = "camera.rate_hz";

std::int64_t nanoseconds(double t_s) noexcept { return std::llround(std::min(t_s * 1e9, 9.2e18)); }  // limit of int64

}  // namespace

FrameClock::Place FrameClock::place(std::uint64_t index) const noexcept {
  std::uint64_t cell = index;
  if (!cells_.empty()) cell = index < cells_.size() ? cells_[index] : cells_.back() + (index - cells_.size() + 1);
  const bool repeats = cadence_ && cadence_->repeats(cell);
  if (cadence_) cell = cadence_->picture(cell);
  // Not accumulated: a sum of rounded periods would drift.
  if (index >= t_ns_.size()) return {cell, nanoseconds(static_cast<double>(cell) / times_.rate_hz), repeats};
  return {cell, t_ns_[index], repeats};
}

class ClockMaker {
 public:
  ClockMaker(const std::string& path, const FrameSource& source, double declared_hz, const ClipTelemetry& telemetry)
      : path_(path), info_(source.info()), declared_hz_(declared_hz), telemetry_(telemetry) {
    clock_.times_.stated_hz = info_.has_rate && std::isfinite(info_.rate_hz) ? info_.rate_hz : 0.0;
    if (info_.scan != nullptr) clock_.times_.prediction = info_.scan->prediction;
    clock_.stamp_file_ = find_timestamp_file(path);
    if (!clock_.stamp_file_.empty()) {
      take_stamps(source);
    } else if (take_telemetry_times()) {
      return;
    } else if (info_.scan == nullptr || info_.scan->times_ns.size() < 2 || !take_container_times()) {
      count_frames();
    }
  }

  [[nodiscard]] FrameClock take() { return std::move(clock_); }

 private:
  void take_stamps(const FrameSource& source) {
    std::vector<std::int64_t> stamps_ns = read_timestamp_file(clock_.stamp_file_);
    // The container's count may be wrong (truncated files, edit lists): before refusing, check whether the frames
    // exist.
    if (stamps_ns.size() < info_.frame_count && source.has_more_frames_than(stamps_ns.size())) {
      throw std::runtime_error(
          fmt::format("{}: {} time stamps for {} frames of {}: write one line per frame, or remove the file to use {}",
                      clock_.stamp_file_, stamps_ns.size(), info_.frame_count, path_,
                      info_.has_rate ? "the container's times" : "camera.rate_hz instead"));
    }
    constexpr double kStampTick_s = 1e-6;
    const TimeFit fit = fit_times(stamps_ns, kStampTick_s, {});
    describe("the stamps of " + std::filesystem::path(clock_.stamp_file_).filename().string(), fit);
    core::RecordingTimes& times = clock_.times_;
    times.n_frames = stamps_ns.size();
    times.rate_hz = declared_hz_ != 0.0 ? declared_hz_ : fit.rate_hz;
    if (!is_usable_rate(times.rate_hz)) {
      throw std::runtime_error(
          fmt::format("{}: {} stamps give a rate of {} Hz, not within {} .. {}: set camera.rate_hz, and check that t_s "
                      "is in seconds",
                      clock_.stamp_file_, stamps_ns.size(), times.rate_hz, kMinRate_hz, kMaxRate_hz));
    }
    if (declared_hz_ == 0.0) refuse_change(clock_.stamp_file_, fit);
    if (contradicts(fit.rate_hz)) {
      remark(fmt::format(
          "camera.rate_hz = {:.6g} contradicts the stamps of {}, which lie {:.6g} Hz apart: frames are put on a grid "
          "of "
          "{:.6g} Hz and cells without a frame are masked; leave camera.rate_hz out to use the stamps' own rate",
          declared_hz_, clock_.stamp_file_, fit.rate_hz, declared_hz_));
    }
    for (const std::int64_t t_ns : stamps_ns) {
      clock_.cells_.push_back(static_cast<std::uint64_t>(
          std::nearbyint(static_cast<double>(t_ns - stamps_ns.front()) * 1e-9 * times.rate_hz)));
    }
    clock_.t_ns_ = std::move(stamps_ns);
  }

  // False: not every frame has such a time, or the times do not fit the frames; a remark states why.
  bool take_telemetry_times() {
    if (telemetry_.times_ns.size() < 2) return false;
    const std::uint64_t n_frames = info_.frame_count, n_times = telemetry_.times_ns.size();
    const TimeFit fit = fit_times(telemetry_.times_ns, telemetry_.tick_s, info_.stated_rates_hz);
    if (const std::string reason = unusable(fit, n_frames, n_times); !reason.empty()) {
      remark(fmt::format("the times in {} were not used: {}", telemetry_.from, reason));
      return false;
    }
    describe("the times in " + telemetry_.from, fit);
    clock_.times_.n_frames = n_frames;
    clock_.times_.rate_hz = fit.rate_hz;
    clock_.cells_ = fit.cells;
    const double container_hz = clock_.times_.stated_hz;
    if (container_hz > 0.0 && std::abs(container_hz / fit.rate_hz - 1.0) > kContradicts) {
      remark(fmt::format("the container states {:.6g} Hz, {} {:.6g} Hz, which is used", container_hz, telemetry_.from,
                         fit.rate_hz));
    }
    // A sensor is clocked by a crystal: small scatter is attributed to the writing of the stamps.
    constexpr double kScatter = 0.05;  // of a period
    if (fit.jitter_s <= kScatter * fit.period_s) return true;
    for (const std::int64_t t_ns : telemetry_.times_ns) {
      const double t_s = clock_.t_ns_.empty() ? 0.0 : static_cast<double>(t_ns) * 1e-9 - fit.phase_s;
      clock_.t_ns_.push_back(nanoseconds(std::max(0.0, t_s)));
    }
    return true;
  }

  [[nodiscard]] std::string unusable(const TimeFit& fit, std::uint64_t n_frames, std::uint64_t n_times) const {
    constexpr double kTooScattered = 0.2;  // of a period: the order of neighbours would be uncertain
    if (n_times + 1 < n_frames || n_times > n_frames + 1)
      return fmt::format("they are {} for {} frames", n_times, n_frames);
    if (!is_usable_rate(fit.rate_hz)) return "they give no rate";
    if (contradicts(fit.rate_hz))
      return fmt::format("they say {:.6g} Hz, camera.rate_hz = {:.6g}", fit.rate_hz, declared_hz_);
    const bool share_a_cell = std::adjacent_find(fit.cells.begin(), fit.cells.end()) != fit.cells.end();
    if (share_a_cell || fit.jitter_s > kTooScattered * fit.period_s)
      return fmt::format("they scatter by {:.2g} ms rms about {:.6g} Hz", 1e3 * fit.jitter_s, fit.rate_hz);
    if (fit.change) return fmt::format("their rate changes at {:.1f} s", fit.change->at_s);
    return {};
  }

  // False: the container's times are unusable.
  bool take_container_times() {
    const PacketScan& scan = *info_.scan;
    if (scan.backward_at_s >= 0.0) {
      if (declared_hz_ != 0.0) return false;
      throw std::runtime_error(
          fmt::format("{}: its times run backward after {:.1f} s (parts that were joined?): cut it there (ffmpeg -i IN "
                      "-t {:.1f} -c "
                      "copy OUT.mp4), or set camera.rate_hz if no frame is missing",
                      path_, scan.backward_at_s, scan.backward_at_s));
    }
    const TimeFit fit = fit_times(scan.times_ns, scan.tick_s, info_.stated_rates_hz);
    if (!is_usable_rate(fit.rate_hz)) return false;
    refuse_change(path_, fit);
    describe("the container's times", fit);
    clock_.times_.n_frames = scan.times_ns.size();
    clock_.cells_ = fit.cells;
    const double scale = scale_to_declared(fit);
    clock_.times_.rate_hz = fit.rate_hz;
    if (clock_.times_.from == kDeclared) clock_.times_.rate_hz = declared_hz_;
    convert_back(fit);
    if (fit.is_even) return true;  // cell / rate, without the rounding of the container's ticks
    // The jitter of the first frame would shift the whole grid relative to the others: that frame is put on its cell.
    for (const std::int64_t t_ns : scan.times_ns) {
      const double t_s = clock_.t_ns_.empty() ? 0.0 : static_cast<double>(t_ns) * 1e-9 - fit.phase_s;
      clock_.t_ns_.push_back(nanoseconds(std::max(0.0, t_s * scale)));
    }
    return true;
  }

  // Factor for the container's times.
  [[nodiscard]] double scale_to_declared(const TimeFit& fit) {
    if (declared_hz_ == 0.0) return 1.0;
    if (!fit.is_even && !contradicts(fit.rate_hz)) {
      remark(fmt::format(
          "camera.rate_hz = {:.6g} was not needed: the container's times are uneven and say {:.6g} Hz, which "
          "is used",
          declared_hz_, fit.rate_hz));
      return 1.0;
    }
    clock_.times_.from = kDeclared;
    if (contradicts(fit.rate_hz) && !fit.is_even) {
      remark(fmt::format(
          "camera.rate_hz = {:.6g} contradicts the container, whose uneven times say {:.6g} Hz: they were scaled to "
          "the "
          "declared rate, as for slow motion; leave camera.rate_hz out to use them as they are",
          declared_hz_, fit.rate_hz));
    }
    clock_.times_.jitter_s *= fit.rate_hz / declared_hz_, clock_.times_.worst_s *= fit.rate_hz / declared_hz_;
    clock_.times_.longest_gap_s *= fit.rate_hz / declared_hz_;
    return fit.rate_hz / declared_hz_;
  }

  // Undoes a rate conversion: repeated frames are left out, the others get the times at which they were filmed. The
  // declared rate may be that of the file or that of the original recording.
  void convert_back(const TimeFit& fit) {
    constexpr std::size_t kLookedAt = 180;
    const std::size_t n = std::min(fit.cells.size(), kLookedAt);
    if (!fit.is_even || fit.cells[n - 1] + 1 != n) return;
    clock_.cadence_ = find_cadence(path_, *info_.scan, info_.decoder_mb);
    if (!clock_.cadence_) return;
    const int shown = clock_.cadence_->shown, of = clock_.cadence_->of;
    double& rate_hz = clock_.times_.rate_hz;
    const bool is_of_recording = declared_hz_ != 0.0 && contradicts(fit.rate_hz);
    if (!is_of_recording) rate_hz *= static_cast<double>(shown) / of;
    remark(
        fmt::format("{} of every {} frames repeat the one before: the recording was converted from {:.6g} to {:.6g} "
                    "frames a second, which was undone",
                    of - shown, of, rate_hz, rate_hz * of / shown));
  }

  void count_frames() {
    core::RecordingTimes& times = clock_.times_;
    times.n_frames = info_.frame_count;
    times.from = declared_hz_ != 0.0 ? kDeclared : "the container's rate";
    times.rate_hz = declared_hz_ != 0.0 ? declared_hz_ : info_.rate_hz;
    if (declared_hz_ == 0.0 && !info_.has_rate) {
      throw std::runtime_error(
          fmt::format("{}: a folder of images has no frame rate: set camera.rate_hz, or write the times into "
                      "{}/timestamps.csv (header frame,t_s)",
                      path_, path_));
    }
    if (is_usable_rate(times.rate_hz)) return;
    throw std::runtime_error(fmt::format(
        "{}: the container states a rate of {} Hz, not within {} .. {}: set camera.rate_hz to the true rate", path_,
        times.rate_hz, kMinRate_hz, kMaxRate_hz));
  }

  void remark(const std::string& words) {
    std::string& all = clock_.times_.remark;
    all += (all.empty() ? "" : "; ") + words;
  }

  [[nodiscard]] bool contradicts(double rate_hz) const noexcept {
    return declared_hz_ != 0.0 && rate_hz > 0.0 && std::abs(rate_hz / declared_hz_ - 1.0) > kContradicts;
  }

  static void refuse_change(const std::string& file, const TimeFit& fit) {
    if (!fit.change) return;
    throw std::runtime_error(fmt::format(
        "{}: the frame rate changes from {:.4g} to {:.4g} Hz at about {:.1f} s: one spectrum cannot hold both; cut the "
        "clip there (ffmpeg -i IN -t {:.1f} -c copy OUT.mp4) and analyse the parts apart, or film with a fixed rate",
        file, fit.change->before_hz, fit.change->after_hz, fit.change->at_s, fit.change->at_s));
  }

  void describe(const std::string& from, const TimeFit& fit) {
    core::RecordingTimes& times = clock_.times_;
    times.from = from;
    times.jitter_s = fit.jitter_s, times.worst_s = fit.worst_s;
    times.n_lost = fit.n_lost, times.n_gaps = fit.n_gaps, times.longest_gap_s = fit.longest_gap_s;
  }

  const std::string& path_;
  const SourceInfo& info_;
  double declared_hz_;
  const ClipTelemetry& telemetry_;
  FrameClock clock_;
};

FrameClock make_frame_clock(const std::string& path, const FrameSource& source, double rate_hz,
                            const ClipTelemetry& telemetry) {
  return ClockMaker(path, source, rate_hz, telemetry).take();
}

}  // namespace drivers
