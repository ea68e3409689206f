#include "drivers/camera/recording/repeats.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numeric>

#include "drivers/camera/recording/packet_scan.h"
#include "drivers/camera/recording/picture_luma.h"
#include "drivers/camera/recording/video_decoder.h"

namespace drivers {

namespace {

constexpr std::size_t kEveryRow = 8;
constexpr std::size_t kProbeFrames = 180;
constexpr int kLongestCadence = 30;

void take_rows(const core::Frame& frame, std::vector<std::uint8_t>& rows) {
  const auto width = static_cast<std::size_t>(frame.width_px);
  rows.clear();
  for (std::size_t at = 0; at + width <= frame.pixels.size(); at += kEveryRow * width) {
    const auto row = frame.pixels.begin() + static_cast<std::ptrdiff_t>(at);
    rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(width));
  }
}

// Mean, gray levels; empty: not of one size.
std::optional<double> difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  if (a.empty() || a.size() != b.size()) return {};
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<std::uint64_t>(std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i])));
  }
  return static_cast<double>(sum) / static_cast<double>(a.size());
}

double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Whether the frames that `cadence` calls repeats are those that hardly change. On measured clips converted from 25 to
// 30 fps and encoded at quality 12 to 23 repeats change by 0.01 to 0.1 of what others do; noise keeps others above
// 0.15.
// around[k]: from frame k - 2 to frame k + 1. It is small, too, where a noiseless motion turns back between k - 1 and
// k.
bool explains(const Cadence& cadence, std::span<const double> changes, std::span<const double> around) {
  constexpr std::size_t kFewestRepeats = 4;
  constexpr double kOfOthers = 0.25, kAmongOthers = 0.05;
  std::vector<double> repeats, others, around_repeats;
  for (std::size_t k = 1; k < changes.size(); ++k) (cadence.repeats(k) ? repeats : others).push_back(changes[k]);
  if (repeats.size() < kFewestRepeats || others.empty()) return false;
  for (std::size_t k = 2; k + 1 < changes.size() && k < around.size(); ++k) {
    if (cadence.repeats(k)) around_repeats.push_back(around[k]);
  }
  if (!around_repeats.empty() && quantile(around_repeats, 0.5) < kOfOthers * quantile(others, 0.5)) return false;
  const double repeat = quantile(repeats, 0.9);
  if (!(repeat < kOfOthers * quantile(others, 0.5))) return false;
  const auto n_below = std::count_if(others.begin(), others.end(), [&](double change) { return change <= repeat; });
  return static_cast<double>(n_below) <= kAmongOthers * static_cast<double>(others.size());
}

// A repeated picture costs few bytes where frames are predicted, and exactly as many as before where they are not.
bool sizes_hint_at_repeats(const std::vector<std::uint32_t>& bytes) {
  constexpr std::size_t kFewest = 4;
  std::size_t n_small = 0, n_same = 0;
  const std::size_t n = std::min(bytes.size(), kProbeFrames);
  for (std::size_t k = 2; k + 2 < n; ++k) {
    std::vector<double> around;
    for (const std::size_t i : {k - 2, k - 1, k + 1, k + 2}) around.push_back(bytes[i]);
    if (bytes[k] < 0.5 * quantile(around, 0.5)) ++n_small;
    if (bytes[k] == bytes[k - 1]) ++n_same;
  }
  return n_small >= kFewest || n_same >= kFewest;
}

}  // namespace

std::optional<double> FrameChange::since_last(const core::Frame& frame) {
  take_rows(frame, now_);
  const std::optional<double> change = difference(now_, last_);
  std::swap(now_, last_);
  return change;
}

bool RepeatWatch::is_repeat(double change) {
  constexpr std::size_t kRemembered = 63, kFewest = 8;
  constexpr double kOfLeast = 0.4, kNoise = 0.05;  // gray levels
  if (accepted_.size() >= kFewest) {
    const double least = *std::min_element(accepted_.begin(), accepted_.end());
    if (least > kNoise && change < kOfLeast * least) return true;
  }
  accepted_.push_back(change);
  if (accepted_.size() > kRemembered) accepted_.pop_front();
  return false;
}

std::optional<Cadence> find_cadence(std::span<const double> changes, std::span<const double> around) {
  for (int of = 2; of <= kLongestCadence; ++of) {
    for (int shown = of - 1; 3 * shown >= of; --shown) {
      if (std::gcd(shown, of) != 1) continue;
      for (int phase = 0; phase < of; ++phase) {
        const Cadence cadence{shown, of, phase};
        if (explains(cadence, changes, around)) return cadence;
      }
    }
  }
  return {};
}

std::optional<Cadence> find_cadence(const std::string& path, const PacketScan& scan) {
  if (!sizes_hint_at_repeats(scan.bytes)) return {};
  VideoDecoder decoder(path);
  std::optional<PictureLuma> luma;
  core::Frame frame;
  std::deque<std::vector<std::uint8_t>> rows;  // of the last four frames
  std::vector<double> changes, around;
  while (changes.size() < kProbeFrames) {
    const DecodeStatus status = decoder.next();
    if (status == DecodeStatus::kEnd) break;
    if (status == DecodeStatus::kDamaged) return {};  // places could not be told
    const AVFrame& picture = decoder.picture();
    if (!luma) luma.emplace(picture);
    if (!luma->fits(picture)) break;
    frame.width_px = picture.width, frame.height_px = picture.height;
    frame.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    luma->read(picture, frame.pixels.data());
    take_rows(frame, rows.emplace_back());
    if (rows.size() > 4) rows.pop_front();
    const std::size_t last = rows.size() - 1;
    changes.push_back(last > 0 ? difference(rows[last], rows[last - 1]).value_or(0.0) : 0.0);
    around.push_back(0.0);
    if (last == 3) around[around.size() - 2] = difference(rows[3], rows[0]).value_or(0.0);
  }
  return find_cadence(changes, around);
}

}  // namespace drivers
