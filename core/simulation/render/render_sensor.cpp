#include "core/simulation/render/render_sensor.h"

#include <algorithm>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr std::size_t kTable = 1U << 19;

// Clamped as integers and without aliasing, so that the compiler takes several pixels at a time.
void quantise(const float* __restrict light, const float* __restrict noise, int n, std::uint8_t* __restrict pixels) {
  for (int i = 0; i < n; ++i) {
    const int grey = static_cast<int>(light[i] + noise[i] + 0.5F);
    pixels[i] = static_cast<std::uint8_t>(grey < 0 ? 0 : grey > 255 ? 255 : grey);
  }
}

}  // namespace

RenderSensor::RenderSensor(const Scene& scene)
    : noise_(kTable + static_cast<std::size_t>(std::max(scene.camera.width_px, scene.camera.height_px))),
      key_(mix64(scene.seed ^ hash_name("sensor_noise_rows"))) {
  RandomStream stream(scene.seed, "sensor_noise");
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    noise_[i] = i < kTable ? static_cast<float>(scene.camera.noise_sigma * stream.gaussian()) : noise_[i - kTable];
  }
}

void RenderSensor::expose(std::uint64_t frame, int line, const float* light, int length,
                          std::uint8_t* pixels) const noexcept {
  const std::uint64_t start = mix64(key_ + mix64(frame) + static_cast<std::uint64_t>(line));
  quantise(light, noise_.data() + start % kTable, length, pixels);
}

}  // namespace core::simulation
