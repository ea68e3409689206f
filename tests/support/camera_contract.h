#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "drivers/camera/camera.h"
#include "tests/support/camera_drain.h"

// Requirements on every driver (drivers/camera/camera.h), whatever its source. A test program instantiates the suite
// with its cameras: unit tests with recordings and scenes, tests/device with kernel devices.
namespace test_support {

struct ContractCamera {
  std::string name;
  std::function<std::unique_ptr<drivers::Camera>()> make;
  bool is_live = false;  // never ends; otherwise it ends, and starts from the beginning when it is started again

  friend void PrintTo(const ContractCamera& camera, std::ostream* out) { *out << camera.name; }
};

class CameraContract : public ::testing::TestWithParam<ContractCamera> {
 protected:
  static constexpr std::chrono::milliseconds kPatience{5000};
  static constexpr int kFrames = 8;

  // The next frame, whatever timeouts come before it.
  static drivers::CaptureStatus next(drivers::Camera& camera, core::Frame& slot) {
    const auto limit = std::chrono::steady_clock::now() + kPatience;
    drivers::CaptureStatus status = drivers::CaptureStatus::kTimeout;
    while (status == drivers::CaptureStatus::kTimeout && std::chrono::steady_clock::now() < limit) {
      status = camera.capture(slot, std::chrono::milliseconds(100));
    }
    return status;
  }
};

TEST_P(CameraContract, SaysWhatItIsBeforeItRuns) {
  const core::CameraInfo info = GetParam().make()->info();
  EXPECT_GE(info.width_px, 32);
  EXPECT_GE(info.height_px, 32);
  EXPECT_TRUE(std::isfinite(info.rate_hz) && info.rate_hz > 0);
  EXPECT_GE(info.exposure_ns, 0);
  EXPECT_FALSE(info.description.empty());
}

TEST_P(CameraContract, NumbersAndStampsItsFrames) {
  const auto camera = GetParam().make();
  camera->start();
  const core::CameraInfo info = camera->info();
  core::Frame slot = make_slot(info);
  const std::uint8_t* const pixels = slot.pixels.data();
  std::uint64_t last = 0;
  std::int64_t last_ns = 0, first_ns = 0;
  double numbers = 0;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_EQ(next(*camera, slot), drivers::CaptureStatus::kFrame) << "frame " << i << ": " << camera->fault();
    EXPECT_EQ(slot.width_px, info.width_px);
    EXPECT_EQ(slot.height_px, info.height_px);
    EXPECT_EQ(slot.pixels.data(), pixels) << "the caller's memory";
    if (i == 0) first_ns = slot.t_start_ns;
    if (i > 0) {
      ASSERT_GT(slot.sequence, last);
      EXPECT_GT(slot.t_start_ns, last_ns);
      EXPECT_EQ(slot.gap_before, slot.sequence != last + 1);
      numbers += static_cast<double>(slot.sequence - last);
    }
    last = slot.sequence;
    last_ns = slot.t_start_ns;
  }
  EXPECT_FALSE(camera->trouble().is_lost);
  EXPECT_TRUE(camera->fault().empty()) << camera->fault();
  if (GetParam().is_live) return;  // the rate of a device is not prescribed
  EXPECT_NEAR(static_cast<double>(last_ns - first_ns) * 1e-9 * info.rate_hz, numbers, 0.25 * numbers)
      << "times and numbers tell of the same rate";
}

TEST_P(CameraContract, ASlotOfTheWrongSizeIsAFault) {
  const auto camera = GetParam().make();
  camera->start();
  core::Frame slot = make_slot(camera->info());
  slot.pixels.assign(slot.pixels.size() / 2, 77);
  EXPECT_EQ(next(*camera, slot), drivers::CaptureStatus::kFault);
  EXPECT_FALSE(camera->fault().empty());
  EXPECT_EQ(std::count(slot.pixels.begin(), slot.pixels.end(), 77), static_cast<long>(slot.pixels.size()));
  EXPECT_EQ(next(*camera, slot), drivers::CaptureStatus::kFault) << "it stays one";
}

TEST_P(CameraContract, ComesBackFromAWaitOfNoTime) {
  const auto camera = GetParam().make();
  camera->start();
  core::Frame slot = make_slot(camera->info());
  for (const int ms : {0, 1, -5}) {
    const auto begun = std::chrono::steady_clock::now();
    const drivers::CaptureStatus status = camera->capture(slot, std::chrono::milliseconds(ms));
    EXPECT_TRUE(status == drivers::CaptureStatus::kFrame || status == drivers::CaptureStatus::kTimeout);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, kPatience);
  }
}

TEST_P(CameraContract, StopsWhileAnotherThreadCaptures) {
  const auto camera = GetParam().make();
  camera->start();
  core::Frame slot = make_slot(camera->info());
  std::atomic<drivers::CaptureStatus> last{drivers::CaptureStatus::kFrame};
  std::thread capturing([&] {
    while (last == drivers::CaptureStatus::kFrame || last == drivers::CaptureStatus::kTimeout)
      last = camera->capture(slot, kPatience);
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  camera->stop();
  capturing.join();
  EXPECT_EQ(last, drivers::CaptureStatus::kEndOfStream);
  const core::Frame before = slot;
  EXPECT_EQ(camera->capture(slot, std::chrono::milliseconds(50)), drivers::CaptureStatus::kEndOfStream);
  EXPECT_EQ(slot.pixels, before.pixels) << "no slot is written after stop";
  EXPECT_EQ(slot.sequence, before.sequence);
}

TEST_P(CameraContract, StopsUnstartedTwiceAndByItsEnd) {
  auto camera = GetParam().make();
  camera->stop();
  camera->start();
  camera->stop();
  camera->stop();
  camera.reset();
  const auto left_running = GetParam().make();  // started after the other camera has released the device
  left_running->start();
}

TEST_P(CameraContract, StartsAgain) {
  const auto camera = GetParam().make();
  core::Frame first = make_slot(camera->info()), slot = first;
  for (int run = 0; run < 3; ++run) {
    camera->start();
    ASSERT_EQ(next(*camera, slot), drivers::CaptureStatus::kFrame) << "run " << run << ": " << camera->fault();
    EXPECT_FALSE(slot.gap_before);
    if (run == 0) first = slot;
    if (!GetParam().is_live) {
      EXPECT_EQ(slot.pixels, first.pixels) << "from the beginning";
      EXPECT_EQ(slot.t_start_ns, first.t_start_ns);
    } else if (run > 0) {
      EXPECT_GT(slot.t_start_ns, first.t_start_ns) << "live";
    }
    ASSERT_EQ(next(*camera, slot), drivers::CaptureStatus::kFrame);
    camera->stop();
  }
}

TEST_P(CameraContract, EndsOnceAndForAll) {
  if (GetParam().is_live) GTEST_SKIP() << "a live camera does not end";
  const auto camera = GetParam().make();
  camera->start();
  const Drained run = drain(*camera);
  EXPECT_EQ(run.last, drivers::CaptureStatus::kEndOfStream) << run.fault;
  EXPECT_EQ(run.frames.size(), camera->info().frame_count);
  core::Frame slot = make_slot(camera->info());
  EXPECT_EQ(camera->capture(slot, std::chrono::milliseconds(1)), drivers::CaptureStatus::kEndOfStream);
}

inline std::string contract_name(const ::testing::TestParamInfo<ContractCamera>& info) { return info.param.name; }

}  // namespace test_support
