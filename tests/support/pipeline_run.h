#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "firmware_app/service/pipeline.h"
#include "tests/support/memory_publisher.h"
#include "tests/support/patience.h"
#include "tests/support/places.h"
#include "tests/support/scripted_camera.h"

namespace tests {

// Items received by the publisher; outlives the pipeline that owned it.
struct Heard {
  std::vector<core::ModalEstimate> estimates;
  std::vector<core::DisplacementSample> samples;
  std::vector<core::TrackFrame> tracks;
  std::vector<core::closure::ClosureReport> closures;
  std::vector<core::Health> health;
};

// Passes the received items to `heard` when the pipeline destroys it; may refuse every message, or be slow.
class TellingPublisher : public MemoryPublisher {
 public:
  explicit TellingPublisher(std::shared_ptr<Heard> heard, bool refuse = false, std::chrono::microseconds pause = {})
      : heard_(std::move(heard)), pause_(pause) {
    fail = refuse;
  }
  ~TellingPublisher() override {
    *heard_ = {std::move(estimates), std::move(samples), std::move(tracks), std::move(closures), std::move(health)};
  }
  using MemoryPublisher::publish;
  bool publish(const core::DisplacementSample& sample, const std::vector<core::ChannelInfo>& infos) noexcept override {
    if (pause_.count() > 0) std::this_thread::sleep_for(pause_);
    return MemoryPublisher::publish(sample, infos);
  }

 private:
  std::shared_ptr<Heard> heard_;
  std::chrono::microseconds pause_;
};

// An empty folder of the running test. Two builds may be tested at the same time.
inline std::filesystem::path own_folder() {
  static const std::string build = std::to_string(std::hash<std::string>{}(tests::program("")) % 1'000'000);
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (char& c : name) c = c == '/' ? '_' : c;
  const auto folder = std::filesystem::path(::testing::TempDir()) / ("hovermodal_" + build) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

inline constexpr std::chrono::seconds kPatience = std::chrono::seconds(60) * kSlowdown;

// True when every stage has ended; false when the time ran out first: a hang.
inline bool runs_to_its_end(app::Pipeline& pipeline, std::chrono::seconds patience = kPatience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (pipeline.running()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

inline bool is_finite(const core::Mode& mode) {
  bool finite = std::isfinite(mode.frequency_hz) && std::isfinite(mode.apparent_hz) &&
                std::isfinite(mode.damping_ratio) && std::isfinite(mode.mpc) && std::isfinite(mode.presence);
  for (const std::complex<double>& x : mode.shape)
    finite = finite && std::isfinite(x.real()) && std::isfinite(x.imag());
  return finite;
}

inline void expect_finite(const core::ModalEstimate& estimate) {
  EXPECT_TRUE(std::isfinite(estimate.rate_hz) && std::isfinite(estimate.duration_s));
  for (const auto* modes : {&estimate.modes, &estimate.rejected}) {
    for (const core::Mode& mode : *modes) EXPECT_TRUE(is_finite(mode)) << mode.frequency_hz << " Hz";
  }
}

// Conditions at the end of every run, whatever its outcome.
inline void expect_accounted(const core::Health& health) {
  EXPECT_EQ(health.frames_in, health.frames_processed + health.frames_dropped);
  const auto stage = [&](const char* name) {
    for (const core::StageHealth& s : health.stages) {
      if (s.name == name) return s;
    }
    ADD_FAILURE() << "no stage " << name;
    return core::StageHealth{};
  };
  EXPECT_EQ(stage("capture").n_in, stage("capture").n_out + stage("capture").n_dropped);
  EXPECT_EQ(stage("tracking").n_in, stage("tracking").n_out + stage("tracking").n_dropped);
  EXPECT_EQ(stage("spectrum").n_in, stage("tracking").n_out);
  EXPECT_EQ(stage("publish").n_in + stage("publish").n_dropped, stage("tracking").n_in);
  EXPECT_EQ(stage("identification").n_in, stage("identification").n_out + stage("identification").n_dropped);
  EXPECT_EQ(stage("publish").n_out, health.estimates);
}

}  // namespace tests
