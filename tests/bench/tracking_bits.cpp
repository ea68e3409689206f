// The point tracker on frames made of integers, so that they are identical wherever this is
// compiled: six regions that sway, drift, jump, are hidden, and change brightness, with noise. Without OpenCV, so that
// it also runs where that is not installed. Prints a line per ten frames: frame, points seen, hash of the bits of
// all positions, sigmas and gains so far.
//   tracking_bits [FRAMES] [SEED] [FINDS]     FINDS: finds the points so many times more in the last frame, to count
//   instructions
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/tracking/outlier_rejection.h"
#include "core/tracking/point_finder.h"
#include "core/tracking/region_follower.h"

namespace {

constexpr int kWidth = 640, kHeight = 480, kRegions = 6, kAcross = 5, kDown = 3;
constexpr int kSmoothings = 3;
constexpr int kStepsPerPx = 16;  // of positions

std::uint32_t hashed(std::uint64_t x) {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<std::uint32_t>(x ^ (x >> 31U));
}

// Grey 0 ... 255, smoothed noise, larger than the image.
class Texture {
 public:
  static constexpr int kMargin = 160, kColumns = kWidth + 2 * kMargin, kRows = kHeight + 2 * kMargin;

  explicit Texture(std::uint64_t seed) : grey_(std::size_t{kColumns} * kRows) {
    for (std::size_t i = 0; i < grey_.size(); ++i) grey_[i] = static_cast<int>(hashed(seed + i) % 256U) - 128;
    for (int k = 0; k < kSmoothings; ++k) smooth();
  }
  // Between pixels, in steps of 1/16.
  [[nodiscard]] int at(int u_steps, int v_steps) const {
    const int u = u_steps / kStepsPerPx, v = v_steps / kStepsPerPx, fu = u_steps % kStepsPerPx,
              fv = v_steps % kStepsPerPx;
    const auto pixel = [&](int du, int dv) { return grey_[static_cast<std::size_t>((v + dv) * kColumns + u + du)]; };
    const int upper = pixel(0, 0) * (kStepsPerPx - fu) + pixel(1, 0) * fu;
    const int lower = pixel(0, 1) * (kStepsPerPx - fu) + pixel(1, 1) * fu;
    return (upper * (kStepsPerPx - fv) + lower * fv) / (kStepsPerPx * kStepsPerPx);
  }

 private:
  void smooth() {
    const std::vector<int> from = grey_;
    for (int v = 1; v + 1 < kRows; ++v) {
      for (int u = 1; u + 1 < kColumns; ++u) {
        int sum = 0;
        for (int y = -1; y <= 1; ++y)
          for (int x = -1; x <= 1; ++x) sum += from[static_cast<std::size_t>((v + y) * kColumns + u + x)];
        grey_[static_cast<std::size_t>(v * kColumns + u)] = sum / 5;  // restores the contrast lost by averaging
      }
    }
  }
  std::vector<int> grey_;
};

struct Motion {
  int u_steps = 0, v_steps = 0;
};
// Each band has its own triangular sway; all have a common drift, and a jump of 45 px in frame 40.
Motion motion_of(int band, int frame) {
  const int period = 10 + 3 * band, phase = frame % (2 * period);
  const int sway = phase < period ? phase : 2 * period - phase;
  const int jump = frame >= 40 && frame < 60 ? 45 * kStepsPerPx : 0;
  return {frame == 0 ? 0 : 3 * sway + 2 * frame + jump, frame == 0 ? 0 : sway - frame};
}

std::vector<std::uint8_t> image(const Texture& texture, int frame, std::uint64_t seed) {
  std::vector<std::uint8_t> out(std::size_t{kWidth} * kHeight);
  const int gain = 16 + (frame % 7) - 3;  // of the light, in 16ths
  for (int v = 0; v < kHeight; ++v) {
    const int band = v * kRegions / kHeight;
    const Motion motion = motion_of(band, frame);
    for (int u = 0; u < kWidth; ++u) {
      const int u_steps = (u + Texture::kMargin) * kStepsPerPx - motion.u_steps;
      const int v_steps = (v + Texture::kMargin) * kStepsPerPx - motion.v_steps;
      const int noise =
          static_cast<int>(hashed((seed << 32U) + static_cast<std::uint64_t>((frame * kHeight + v) * kWidth + u)) % 5U);
      const bool is_hidden = band == 2 && frame >= 20 && frame < 30;
      const int grey = is_hidden ? 90 : 120 + gain * texture.at(u_steps, v_steps) / 16 + noise;
      out[static_cast<std::size_t>(v * kWidth + u)] = static_cast<std::uint8_t>(grey < 0 ? 0 : grey > 255 ? 255 : grey);
    }
  }
  return out;
}

class Hash {  // FNV-1a
 public:
  void add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned k = 0; k < 64; k += 8) hash_ = (hash_ ^ ((bits >> k) & 255U)) * 0x100000001B3U;
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

struct Points {
  std::vector<core::Vector2> keyframe;
  std::vector<std::uint16_t> region;
};
Points grid() {
  Points out;
  constexpr int kApart = 24, kBand = kHeight / kRegions;
  for (int r = 0; r < kRegions; ++r) {
    for (int k = 0; k < kAcross * kDown; ++k) {
      out.keyframe.push_back({200.0 + kApart * (k % kAcross), r * kBand + 16.0 + kApart * (k / kAcross)});
      out.region.push_back(static_cast<std::uint16_t>(r));
    }
  }
  return out;
}

core::TrackFrame judged(const std::vector<core::KltPoint>& found, const Points& points) {
  constexpr std::size_t kPerRegion = std::size_t{kAcross} * kDown;
  core::TrackFrame out;
  for (std::size_t i = 0; i < found.size(); ++i)
    out.points.push_back({found[i].position.u, found[i].position.v, found[i].sigma_px, static_cast<std::uint32_t>(i),
                          points.region[i], found[i].seen, false});
  for (std::size_t first = 0; first < found.size(); first += kPerRegion) {
    std::vector<core::Vector2> motion;
    std::vector<std::uint8_t> valid, inlier(kPerRegion);
    for (std::size_t i = first; i < first + kPerRegion; ++i) {
      motion.push_back({found[i].position.u - points.keyframe[i].u, found[i].position.v - points.keyframe[i].v});
      valid.push_back(found[i].seen ? 1 : 0);
    }
    (void)core::mlesac_translation(motion, valid, {}, inlier);
    for (std::size_t k = 0; k < kPerRegion; ++k) out.points[first + k].inlier = inlier[k] != 0;
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const int n_frames = argc > 1 ? std::atoi(argv[1]) : 100;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const Texture texture(seed << 32U);
  const Points points = grid();
  const std::vector<std::uint8_t> keyframe = image(texture, 0, seed);
  const auto view = [](const std::vector<std::uint8_t>& pixels) {
    return core::GrayView{pixels.data(), kWidth, kHeight, kWidth};
  };
  core::PointFinder finder({}, view(keyframe), points.keyframe, points.region, kRegions);
  core::RegionFollower follower(core::RegionFollowerConfig{kWidth, kHeight}, points.keyframe, points.region, kRegions);
  Hash hash;
  std::vector<std::uint8_t> pixels;
  for (int frame = 0; frame < n_frames; ++frame) {
    pixels = image(texture, frame, seed);
    finder.find(view(pixels), follower);
    std::size_t n_seen = 0;
    for (const core::KltPoint& point : finder.points()) {
      hash.add(point.position.u), hash.add(point.position.v), hash.add(point.sigma_px), hash.add(point.gain);
      n_seen += point.seen ? 1 : 0;
    }
    const core::TrackFrame now = judged(finder.points(), points);
    follower.update(now);
    finder.learn(now);
    if (frame % 10 == 9)
      std::printf("%d\t%zu of %zu\t%016llx\n", frame, n_seen, points.keyframe.size(),
                  static_cast<unsigned long long>(hash.value()));
  }
  for (int k = argc > 3 ? std::atoi(argv[3]) : 0; k > 0; --k) finder.find(view(pixels), follower);
}
