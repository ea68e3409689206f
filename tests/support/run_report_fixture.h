#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/storage/text_file.h"
#include "firmware_app/report/run_report.h"

namespace app {

namespace fs = std::filesystem;

// A folder, a camera, two channels, and the data that a run passes to its report.
class RunReportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) / "run_report_test" /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    camera_.width_px = 1920, camera_.height_px = 1080, camera_.rate_hz = 25.0;
    camera_.readout_ns = -26'000'000, camera_.exposure_ns = 4'000'000;
    camera_.readout_direction = core::ReadoutDirection::kUp;
    channels_.resize(2);
    channels_[0].name = "base", channels_[1].name = "roof";
    channels_[1].row_delay_s = 0.0125;
    config_.scale.known_length_mm = 100.0, config_.scale.to_px = {100.0, 0.0};
  }
  [[nodiscard]] RunReport open(const std::string& name = "r") const {
    return {path(name), config_, camera_, channels_, {"base", "roof"}};
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static std::string text_of(const std::string& path) { return drivers::read_text_file(path, 1U << 28U); }

  [[nodiscard]] static core::TrackFrame frame(std::uint64_t sequence, std::size_t n_points) {
    core::TrackFrame out;
    out.sequence = sequence;
    out.t_start_ns = static_cast<std::int64_t>(sequence) * 40'000'001;
    for (std::size_t i = 0; i < n_points; ++i) {
      core::TrackPoint point;
      point.id = static_cast<std::uint32_t>(i);
      point.region = static_cast<std::uint16_t>(i % 2);
      point.u_px = 100.0 + static_cast<double>(i) + 1e-4 * static_cast<double>(sequence % 100);
      point.v_px = 50.25;
      point.sigma_px = 0.0125;
      point.seen = (i + sequence) % 5 != 4;
      out.points.push_back(point);
    }
    return out;
  }
  [[nodiscard]] static core::DisplacementSample sample(std::uint64_t sequence) {
    core::DisplacementSample out;
    out.sequence = sequence;
    out.t_start_ns = static_cast<std::int64_t>(sequence) * 40'000'000;
    out.scale_mm_per_px = 0.95;
    out.value_mm = {1.5, -0.25};
    out.sigma_mm = {0.1, 0.1};
    out.seen = {1, static_cast<std::uint8_t>(sequence % 2)};
    return out;
  }
  [[nodiscard]] static core::ModalEstimate estimate() {
    core::ModalEstimate out;
    out.n_samples = 1500, out.n_segments = 4, out.rate_hz = 25.0, out.duration_s = 60.0;
    core::Mode mode;
    mode.frequency_hz = 1.657, mode.apparent_hz = 1.657, mode.damping_ratio = 0.01, mode.mpc = 0.99, mode.emac = 0.9;
    mode.frequency_std_hz = 0.002;
    mode.shape = {{0.1, -0.02}, {1.0, 0.0}};
    mode.verdict = core::Verdict::kStructural;
    mode.reason = "present in 14 of 15 orders";
    out.modes.push_back(mode);
    out.modes.back().history = core::ModeHistory{2, 5, 1, 30.0, 0, -0.0005, 0.000125, true, 120.5};
    mode.verdict = core::Verdict::kNumerical;
    mode.shape_std = {0.1, 0.2};
    mode.fold_n = -1;
    mode.fold_margin = 0.25;
    out.rejected.push_back(mode);
    return out;
  }
  fs::path folder_;
  core::CameraInfo camera_;
  std::vector<core::ChannelInfo> channels_;
  AppConfig config_;
};

}  // namespace app
