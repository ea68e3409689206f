#ifdef HOVERMODAL_WITH_LCM
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "drivers/telemetry/decode.h"
#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/preview_jpeg.h"
#include "drivers/telemetry/stream_monitor.h"

namespace {

core::Preview picture(int width, int height) {
  core::Preview out;
  out.sequence = 42, out.t_start_ns = 1'000'000'000;
  out.width_px = width, out.height_px = height;
  out.reduction = 6;
  out.image_width_px = width * 6, out.image_height_px = height * 6;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      out.pixels.push_back(static_cast<std::uint8_t>(128.0 + 100.0 * std::sin(x * 0.1) * std::cos(y * 0.07)));
  }
  out.points = {
      {100.0, 50.0, 0.1, 0, 0, true, true}, {101.0, 50.0, 0.1, 1, 0, true, false}, {0.0, 0.0, 0.0, 2, 1, false, false}};
  out.shifts = {{2.0, -1.0, 2}, {}};
  return out;
}

std::vector<core::Region> regions() {
  core::Region roof, base;
  roof.u_px = 90.0, roof.v_px = 40.0, roof.width_px = 60.0, roof.height_px = 20.0;
  base = roof;
  base.v_px = 300.0, base.role = core::RegionRole::kBase;
  return {roof, base};
}

TEST(LcmPreview, TheJpegShowsThePicture) {
  const core::Preview preview = picture(320, 180);
  const auto bytes = drivers::preview_jpeg(preview);
  const cv::Mat image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.type(), CV_8UC1);
  ASSERT_EQ(image.cols, 320);
  ASSERT_EQ(image.rows, 180);
  double square = 0.0;
  for (int i = 0; i < 320 * 180; ++i)
    square += std::pow(image.data[i] - preview.pixels[static_cast<std::size_t>(i)], 2);
  EXPECT_LT(std::sqrt(square / (320 * 180)), 4.0) << "gray levels; quality 50 of a smooth picture";
}

TEST(LcmPreview, AJpegOfNoiseStaysSmall) {
  core::Preview preview = picture(320, 180);
  std::mt19937 draw(1);
  for (auto& pixel : preview.pixels) pixel = static_cast<std::uint8_t>(draw() % 256);
  EXPECT_LE(drivers::preview_jpeg(preview).size(), drivers::kPreviewJpegBytes);
}

TEST(LcmPreview, RefusesPixelsThatAreNoPicture) {
  core::Preview preview = picture(320, 180);
  preview.pixels.pop_back();
  EXPECT_THROW((void)drivers::preview_jpeg(preview), std::runtime_error);
}

TEST(LcmPreview, TellsWhereRegionsAndPointsAreNow) {
  const auto message = drivers::to_message(picture(320, 180), regions(), {"tower", 1});
  EXPECT_EQ(message.frame_sequence, 42);
  EXPECT_FLOAT_EQ(message.scale, 6.0F);
  ASSERT_EQ(message.n_regions, 2);
  EXPECT_FLOAT_EQ(message.region_u_px[0], 92.0F);
  EXPECT_FLOAT_EQ(message.region_v_px[0], 39.0F);
  EXPECT_TRUE(message.region_moved[0]);
  EXPECT_FLOAT_EQ(message.region_v_px[1], 300.0F);
  EXPECT_FALSE(message.region_moved[1]);
  EXPECT_EQ(message.region_role[1], 1);
  ASSERT_EQ(message.n_points, 3);
  EXPECT_FLOAT_EQ(message.u_px[0], 100.0F);
  EXPECT_EQ(message.inlier[1], 0);
  EXPECT_TRUE(std::isnan(message.u_px[2]));
}

TEST(LcmPreview, ThinsPointsEvenly) {
  core::Preview preview = picture(64, 64);
  for (const std::size_t n : {999U, 1000U, 1001U, 2500U, 100000U}) {
    preview.points.assign(n, preview.points[0]);
    const auto message = drivers::to_message(preview, regions(), {"tower", 1});
    EXPECT_LE(message.n_points, 1000) << n;
    EXPECT_GE(message.n_points, n <= 1000 ? static_cast<int>(n) : 500) << n;
  }
}

TEST(LcmPreview, TheMonitorKeepsTheNewest) {
  drivers::StreamMonitor monitor("TEST");
  EXPECT_FALSE(monitor.preview());
  auto message = drivers::to_message(picture(320, 180), regions(), {"tower", 1});
  for (const std::int64_t sequence : {0, 1}) {
    message.sequence = sequence, message.utc_ns = sequence + 1;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    ASSERT_EQ(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
    monitor.receive("TEST_PREVIEW", bytes.data(), bytes.size(), 1);
  }
  ASSERT_TRUE(monitor.preview());
  EXPECT_EQ(monitor.preview()->sequence, 1);
  EXPECT_EQ(monitor.preview()->jpeg, message.jpeg);
  EXPECT_EQ(monitor.count(drivers::kPreview).gaps, 0U);
}

}  // namespace
#endif
