#ifdef HOVERMODAL_WITH_LCM
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drivers/storage/text_file.h"
#include "drivers/telemetry/record_folder.h"
#include "drivers/telemetry/run_record_reader.h"
#include "drivers/telemetry/run_recorder.h"
#include "tests/support/folder_test.h"

namespace drivers {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::size_t kPoints = 12;

core::TrackFrame frame_of(std::uint64_t sequence) {
  core::TrackFrame frame;
  frame.sequence = sequence;
  frame.t_start_ns = static_cast<std::int64_t>(sequence) * 40'000'000 + 7;
  frame.gap_before = sequence % 5 == 3;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double x = std::sin(static_cast<double>(sequence * 31 + i));
    core::TrackPoint point{100.0 + x, 200.0 / 3.0 + x, 0.01 + x * x / 3.0};
    point.id = static_cast<std::uint32_t>(3'000'000'000U + i);
    point.region = static_cast<std::uint16_t>(i / 6);
    point.seen = sequence == 0 || (sequence + i) % 7 != 0;
    if (!point.seen) point.u_px = point.v_px = std::numeric_limits<double>::quiet_NaN();
    frame.points.push_back(point);
  }
  return frame;
}

class RunRecord : public tests::FolderTest {
 protected:
  [[nodiscard]] RecordOptions options(std::uint64_t file_bytes = 1'000'000,
                                      std::uint64_t quota_bytes = 10'000'000) const {
    return {folder_.string(), file_bytes, quota_bytes, "HOVERMODAL", {"bridge", 42}};
  }
  [[nodiscard]] static core::RunHead head() {
    core::RunHead head;
    head.config_yaml = "camera: {rate_hz: 25}\n";
    head.camera = {640, 480, 23.976023976023978, -12'345'678, core::ReadoutDirection::kUp, 4'000'000, 99, true, "a"};
    head.keyframe = frame_of(0);
    head.files = {{"calibration.file", "c.yaml", std::string(600'000, 'x') + "end"}, {"camera.attitude_file", "a", ""}};
    head.continues = true;
    return head;
  }
  // Records frames 0 .. n - 1; returns the path of the first file.
  std::string record(std::uint64_t n, const RecordOptions& options) {
    const auto recorder = make_run_recorder(options);
    recorder->begin(head());
    for (std::uint64_t k = 0; k < n; ++k) (void)recorder->add(frame_of(k), attitude_of(k), stride_of(k));
    n_lost_ = recorder->n_lost();
    return recorder->path();
  }
  static std::uint32_t stride_of(std::uint64_t k) { return k % 11 < 7 ? 1 : 3; }
  static core::AttitudeBatch attitude_of(std::uint64_t k) {
    core::AttitudeBatch batch;
    for (std::uint64_t i = 0; i < (k == 4 ? 70 : k % 3); ++i)
      batch.add({static_cast<double>(k) / 3.0, {0.5, 0.1 * static_cast<double>(i), 0.25, 1.0 / 3.0}});
    return batch;
  }
  static void expect_same(const core::RecordedFrame& read, std::uint64_t k) {
    const core::TrackFrame expected = frame_of(k);
    EXPECT_EQ(read.tracks.sequence, expected.sequence);
    EXPECT_EQ(read.tracks.t_start_ns, expected.t_start_ns);
    EXPECT_EQ(read.tracks.gap_before, expected.gap_before);
    EXPECT_EQ(read.stride, stride_of(k));
    for (std::size_t i = 0; i < kPoints; ++i) {
      const core::TrackPoint &a = read.tracks.points[i], &b = expected.points[i];
      EXPECT_EQ(a.seen, b.seen);
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.region, b.region);
      EXPECT_EQ(a.sigma_px, b.sigma_px);
      if (!b.seen) continue;
      EXPECT_EQ(a.u_px, b.u_px);
      EXPECT_EQ(a.v_px, b.v_px);
    }
    const core::AttitudeBatch attitude = attitude_of(k);
    ASSERT_EQ(read.attitude.n, attitude.n);
    EXPECT_EQ(read.attitude.n_left_out, attitude.n_left_out);
    for (std::size_t i = 0; i < attitude.n; ++i) {
      EXPECT_EQ(read.attitude.samples[i].t_s, attitude.samples[i].t_s);
      EXPECT_EQ(read.attitude.samples[i].wxyz, attitude.samples[i].wxyz);
    }
  }

  std::uint64_t n_lost_ = 0;
};

TEST_F(RunRecord, ComesBackToTheLastBit) {
  RunRecordReader reader(record(20, options()));
  const core::RunHead expected = head();
  EXPECT_EQ(reader.head().config_yaml, expected.config_yaml);
  EXPECT_EQ(reader.head().camera.rate_hz, expected.camera.rate_hz);
  EXPECT_EQ(reader.head().camera.readout_ns, expected.camera.readout_ns);
  EXPECT_EQ(reader.head().camera.readout_direction, expected.camera.readout_direction);
  EXPECT_EQ(reader.head().camera.lossless, expected.camera.lossless);
  EXPECT_TRUE(reader.head().continues);
  ASSERT_EQ(reader.head().files.size(), 2U);
  EXPECT_EQ(reader.head().files[0].bytes, expected.files[0].bytes);
  EXPECT_EQ(reader.head().files[1].key, "camera.attitude_file");
  core::RecordedFrame frame;
  for (std::uint64_t k = 0; k < 20; ++k) {
    EXPECT_LT(reader.bytes_read(), reader.bytes());
    ASSERT_TRUE(reader.next(frame)) << k;
    expect_same(frame, k);
  }
  EXPECT_FALSE(reader.next(frame));
  EXPECT_EQ(reader.bytes_read(), reader.bytes());
  EXPECT_EQ(reader.n_damaged(), 0U);
  EXPECT_EQ(reader.n_attitudes_left_out(), 6U);
  EXPECT_FALSE(reader.starts_late());
  EXPECT_EQ(reader.end(), "") << "no last word: cut off";
}

TEST_F(RunRecord, StatesOfTheAircraftComeBackBeforeTheFrameThatTheyPreceded) {
  auto recorder = make_run_recorder(options());
  recorder->begin(head());
  core::AircraftBatch two;
  two.n = 2;
  two.states[0].motor_hz[1] = 95.125, two.states[1].wind_m_s = 4.0 / 3.0, two.states[1].latitude_deg = 47.1;
  for (std::uint64_t k = 0; k < 3; ++k) {
    if (k == 1) (void)recorder->add(two);
    (void)recorder->add(frame_of(k), attitude_of(k), stride_of(k));
  }
  ASSERT_TRUE(recorder->close());
  RunRecordReader reader(recorder->path());
  core::RecordedFrame frame;
  for (std::uint64_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(reader.next(frame));
    ASSERT_EQ(reader.aircraft().n, k == 1 ? 2U : 0U) << k;
    if (k != 1) continue;
    EXPECT_EQ(reader.aircraft().states[0].motor_hz, two.states[0].motor_hz);
    EXPECT_EQ(reader.aircraft().states[1].wind_m_s, 4.0 / 3.0);
  }
  EXPECT_EQ(reader.n_damaged(), 0U);
}

core::RecordingTimes uneven_times() {
  core::RecordingTimes times;
  times.from = "the container's times";
  times.rate_hz = 29.97, times.stated_hz = 30.0;
  times.jitter_s = 1.0 / 3e4, times.worst_s = 0.011;
  times.n_frames = 1500, times.n_lost = 13, times.n_gaps = 2, times.longest_gap_s = 0.4;
  times.n_repeated = 7, times.n_damaged = 3, times.n_after_damage = 11;
  times.prediction = core::FramePrediction::kPast;
  times.remark = "the frames are parts of two recordings";
  return times;
}

TEST_F(RunRecord, HowTheRecordingLayInTimeComesBackBehindTheLastFrame) {
  auto recorder = make_run_recorder(options());
  recorder->begin(head());
  (void)recorder->add(frame_of(0), attitude_of(0), 1);
  ASSERT_TRUE(recorder->end(uneven_times()));
  const std::string path = recorder->path();
  recorder.reset();
  RunRecordReader reader(path);
  EXPECT_FALSE(reader.times().known()) << "nothing is known before the end";
  core::RecordedFrame frame;
  while (reader.next(frame)) {
  }
  EXPECT_EQ(reader.times(), uneven_times());
  EXPECT_EQ(reader.n_damaged(), 0U);
}

TEST_F(RunRecord, TimesThatCannotBeAreCountedAsDamaged) {
  core::RecordingTimes times = uneven_times();
  times.jitter_s = std::numeric_limits<double>::quiet_NaN();
  auto recorder = make_run_recorder(options());
  recorder->begin(head());
  ASSERT_TRUE(recorder->end(times));
  const std::string path = recorder->path();
  recorder.reset();
  RunRecordReader reader(path);
  core::RecordedFrame frame;
  EXPECT_FALSE(reader.next(frame));
  EXPECT_FALSE(reader.times().known());
  EXPECT_EQ(reader.n_damaged(), 1U);
}

TEST_F(RunRecord, GoesOnInFurtherFilesEachOfWhichHasTheHead) {
  const std::string path = record(5000, options(1'000'000));
  const auto parts = record_parts(folder_.string());
  ASSERT_GE(parts.size(), 3U);
  for (const RecordPart& part : parts) EXPECT_LT(part.n_bytes, 1'010'000U);
  RunRecordReader whole(path);
  core::RecordedFrame frame;
  std::uint64_t n = 0;
  while (whole.next(frame)) expect_same(frame, n++);
  EXPECT_EQ(n, 5000U);
  EXPECT_EQ(whole.files().size(), parts.size());

  RunRecordReader late(parts[1].path);
  EXPECT_TRUE(late.starts_late());
  EXPECT_EQ(late.head().files[0].bytes, head().files[0].bytes);
  ASSERT_TRUE(late.next(frame));
  expect_same(frame, frame.tracks.sequence);
}

TEST_F(RunRecord, TheOldestRunsMakeRoomAndThePresentOneNever) {
  (void)record(10, options());
  (void)record(10, options());
  EXPECT_EQ(record_parts(folder_.string()).size(), 2U);
  (void)record(4000, options(1'000'000, 2'600'000));  // two files, and no third
  const auto parts = record_parts(folder_.string());
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].run, 3);
  EXPECT_EQ(parts[1].run, 3);
  EXPECT_GT(n_lost_, 0U) << "what found no room is counted";
  RunRecordReader reader(parts[0].path);
  core::RecordedFrame frame;
  std::uint64_t n = 0;
  while (reader.next(frame)) ++n;
  EXPECT_EQ(n + n_lost_, 4000U);
}

TEST_F(RunRecord, AnyDamageIsLeftOutAndCounted) {
  const std::string path = record(200, options());
  const std::string whole = read_text_file(path, 100'000'000);
  std::uint64_t seed = 1;
  const auto random = [&seed](std::size_t n) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(seed >> 33U) % n;
  };
  for (int trial = 0; trial < 60; ++trial) {
    std::string bytes = whole.substr(0, trial % 3 == 0 ? random(whole.size()) : whole.size());
    for (int i = 0; i < 20 && !bytes.empty(); ++i) bytes[random(bytes.size())] = static_cast<char>(random(256));
    const std::string damaged = (folder_ / "x_run0009_000.lcm").string();
    std::ofstream(damaged, std::ios::binary) << bytes;
    try {
      RunRecordReader reader(damaged);
      core::RecordedFrame frame;
      std::uint64_t n = 0;
      while (reader.next(frame)) {
        EXPECT_EQ(frame.tracks.points.size(), reader.head().keyframe.points.size());
        ++n;
      }
      EXPECT_LE(n, 200U);
    } catch (const FileError& refused) {
      EXPECT_THAT(refused.what(), HasSubstr("x_run0009_000.lcm"));
    }
  }
}

TEST_F(RunRecord, SaysWhatIsNoRecord) {
  for (const std::string text : {"", "no log at all"}) {
    try {
      RunRecordReader reader(file(text));
      FAIL() << "taken";
    } catch (const FileError& refused) {
      EXPECT_THAT(refused.what(), HasSubstr("holds no recorded run"));
    }
  }
  EXPECT_THROW(RunRecordReader("/nowhere/a.lcm"), FileError);
  EXPECT_THROW((void)make_run_recorder({"/proc/none", 1000, 10000, "HOVERMODAL", {"bridge", 1}}), std::runtime_error);
}

TEST_F(RunRecord, WhatARunLeftWithoutAHeadIsRemoved) {
  const std::string left = "x_run0001_003.lcm.partial", of_others = "notes.partial";
  for (const std::string& name : {left, of_others}) std::ofstream(folder_ / name) << "begun";
  EXPECT_EQ(fs::path(record(3, options())).filename(), "bridge_run0001_000.lcm");
  EXPECT_FALSE(fs::exists(folder_ / left));
  EXPECT_TRUE(fs::exists(folder_ / of_others));
}

}  // namespace
}  // namespace drivers
#endif
