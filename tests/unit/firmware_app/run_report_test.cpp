#include "firmware_app/report/run_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/modal_json.h"

namespace app {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

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
    config_.scale.known_length_mm = 100.0;
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
    mode.frequency_hz = 1.657, mode.apparent_hz = 1.657, mode.damping_ratio = 0.01, mode.mpc = 0.99;
    mode.frequency_std_hz = 0.002;
    mode.shape = {{0.1, -0.02}, {1.0, 0.0}};
    mode.verdict = core::Verdict::kStructural;
    mode.reason = "present in 14 of 15 orders";
    out.modes.push_back(mode);
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

TEST_F(RunReportTest, TracksComeBackAsTheyWere) {
  RunReport report = open();
  std::vector<core::TrackFrame> frames;
  for (std::uint64_t k : {0U, 1U, 2U, 5U}) frames.push_back(frame(k, 13));
  for (const core::TrackFrame& f : frames) EXPECT_TRUE(report.add(f));
  report.finish(estimate(), {}, {});
  const drivers::TracksFile back = drivers::read_tracks_csv(path("r/tracks.csv"));
  EXPECT_EQ(back.camera.width_px, 1920);
  EXPECT_EQ(back.camera.readout_ns, camera_.readout_ns);
  EXPECT_EQ(back.camera.exposure_ns, camera_.exposure_ns);
  EXPECT_EQ(back.camera.readout_direction, camera_.readout_direction);
  EXPECT_THAT(back.region_names, ElementsAre("base", "roof"));
  ASSERT_EQ(back.frames.size(), frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(back.frames[k].sequence, frames[k].sequence);
    EXPECT_EQ(back.frames[k].t_start_ns, frames[k].t_start_ns);
    std::size_t i_back = 0;
    for (const core::TrackPoint& point : frames[k].points) {
      if (!point.seen) continue;
      ASSERT_LT(i_back, back.frames[k].points.size());
      const core::TrackPoint& p = back.frames[k].points[i_back++];
      EXPECT_EQ(p.id, point.id);
      EXPECT_EQ(p.region, point.region);
      EXPECT_NEAR(p.u_px, point.u_px, 5.0001e-5);
      EXPECT_NEAR(p.v_px, point.v_px, 5.0001e-5);
      EXPECT_NEAR(p.sigma_px, point.sigma_px, 5.0001e-6);
    }
    EXPECT_EQ(i_back, back.frames[k].points.size()) << "a lost point has a line";
  }
}

TEST_F(RunReportTest, DisplacementsLeaveMissingCellsEmpty) {
  RunReport report = open();
  for (std::uint64_t k : {0U, 1U}) EXPECT_TRUE(report.add(sample(k)));
  report.finish(estimate(), {}, {});
  EXPECT_THAT(text_of(path("r/displacements.csv")),
              HasSubstr("# unit: mm\n# rate_hz: 25\n# row_delay_s.base: 0\n# row_delay_s.roof: 0.0125\n"
                        "frame,t_s,scale_mm_per_px,base,roof\n0,0.000000000,0.95,1.500000,\n1,0.040000000,0.95,1."
                        "500000,-0.250000\n"));
  const drivers::SeriesFile back = drivers::read_series_csv(path("r/displacements.csv"));
  EXPECT_TRUE(std::isnan(back.columns[4][0]));
  EXPECT_EQ(back.columns[4][1], -0.25);
  EXPECT_EQ(back.comments.at("row_delay_s.roof"), "0.0125");
}

TEST_F(RunReportTest, ModalJsonHasExactlyTheAgreedLayout) {
  core::Health losses;
  losses.frames_in = 10, losses.frames_processed = 9, losses.frames_dropped = 1;
  const std::string text = modal_json({"paper", {"base", "roof"}, estimate(), {"camera roll"}, losses});
  EXPECT_EQ(text, R"({
  "version": 1,
  "method": "paper",
  "rate_hz": 25,
  "duration_s": 60,
  "samples": 1500,
  "segments": 4,
  "modes": [
    {
      "frequency_hz": 1.657,
      "frequency_std_hz": 0.002,
      "apparent_hz": 1.657,
      "fold_n": null,
      "fold_margin": null,
      "damping_ratio": 0.01,
      "damping_std": null,
      "shape": {
        "base": [0.1, -0.02],
        "roof": [1, 0]
      },
      "shape_std": null,
      "mpc": 0.99,
      "verdict": "structural",
      "reason": "present in 14 of 15 orders"
    }
  ],
  "rejected": [
    {
      "frequency_hz": 1.657,
      "frequency_std_hz": 0.002,
      "apparent_hz": 1.657,
      "fold_n": -1,
      "fold_margin": 0.25,
      "damping_ratio": 0.01,
      "damping_std": null,
      "shape": {
        "base": [0.1, -0.02],
        "roof": [1, 0]
      },
      "shape_std": {
        "base": 0.1,
        "roof": 0.2
      },
      "mpc": 0.99,
      "verdict": "numerical",
      "reason": "present in 14 of 15 orders"
    }
  ],
  "corrections": [
    "camera roll"
  ],
  "losses": {
    "frames_in": 10,
    "frames_processed": 9,
    "frames_dropped": 1,
    "frames_missing": 0,
    "samples_masked": 0,
    "snapshots_skipped": 0
  }
}
)");
}

TEST_F(RunReportTest, ModalJsonComesBackAsItWas) {
  RunReport report = open();
  core::Health losses;
  losses.frames_missing = 3;
  report.finish(estimate(), losses, {"camera roll"});
  const ModalReport back = read_modal_json(path("r/modal.json"));
  EXPECT_EQ(back.method, "hovermodal");
  EXPECT_THAT(back.channel_names, ElementsAre("base", "roof"));
  EXPECT_EQ(modal_json(back), text_of(path("r/modal.json")));
}

TEST_F(RunReportTest, NeverWritesWhatIsNotFinite) {
  RunReport report = open();
  core::TrackFrame tracks = frame(0, 3);
  tracks.points[1].u_px = std::nan("");
  EXPECT_TRUE(report.add(tracks));
  core::DisplacementSample displacement = sample(1);
  displacement.value_mm[0] = std::numeric_limits<double>::infinity();
  displacement.scale_mm_per_px = std::nan("");
  EXPECT_TRUE(report.add(displacement));
  core::ModalEstimate last = estimate();
  last.modes[0].frequency_hz = std::nan("");
  report.finish(last, {}, {});
  EXPECT_EQ(report.n_not_finite(), 3U);
  EXPECT_THAT(text_of(path("r/modal.json")), AllOf(HasSubstr("\"frequency_hz\": null"), Not(HasSubstr("nan"))));
  EXPECT_THAT(text_of(path("r/displacements.csv")), HasSubstr("\n1,0.040000000,,,-0.250000\n"));
  EXPECT_EQ(drivers::read_tracks_csv(path("r/tracks.csv")).frames[0].points.size(), 2U);
}

TEST_F(RunReportTest, IdenticalRunsGiveIdenticalBytes) {
  for (const char* name : {"a", "b/c"}) {
    RunReport report = open(name);
    for (std::uint64_t k = 0; k < 100; ++k) {
      EXPECT_TRUE(report.add(frame(k, 50)));
      EXPECT_TRUE(report.add(sample(k)));
    }
    report.finish(estimate(), {}, {});
  }
  for (const char* file : {"modal.json", "tracks.csv", "displacements.csv"}) {
    EXPECT_EQ(text_of(path(std::string("a/") + file)), text_of(path(std::string("b/c/") + file)));
  }
}

TEST_F(RunReportTest, RefusesFoldersThatCannotBe) {
  std::ofstream(path("file")) << "x";
  EXPECT_THROW(open("file"), drivers::FileError);
  EXPECT_THROW(open("file/below"), drivers::FileError);
  EXPECT_THROW(RunReport("", config_, camera_, channels_, {}), drivers::FileError);
  EXPECT_THROW(RunReport("/proc/report", config_, camera_, channels_, {}), drivers::FileError);
  fs::create_directories(path("taken/tracks.csv.partial"));
  EXPECT_THROW(open("taken"), drivers::FileError);
}

TEST_F(RunReportTest, RemovesTheResultsOfAnEarlierRunAtOnce) {
  fs::create_directories(path("r"));
  for (const char* name : {"r/modal.json", "r/tracks.csv", "r/displacements.csv"}) std::ofstream(path(name)) << "old";
  config_.report.tracks = false;
  RunReport report = open();
  for (const char* name : {"r/modal.json", "r/tracks.csv", "r/displacements.csv"})
    EXPECT_FALSE(fs::exists(path(name))) << name;
  EXPECT_TRUE(report.add(frame(0, 5)));
  report.finish(estimate(), {}, {});
  EXPECT_FALSE(fs::exists(path("r/tracks.csv")));
  EXPECT_TRUE(fs::exists(path("r/modal.json")));
}

TEST_F(RunReportTest, TellsOnceThatTheDiskIsFull) {
  fs::create_directories(path("r"));
  fs::create_symlink("/dev/full", path("r/tracks.csv.partial"));
  RunReport report = open();
  bool failed = false;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    failed = !report.add(frame(k, 20)) || failed;
    EXPECT_TRUE(report.add(sample(k)));
  }
  EXPECT_TRUE(failed);
  EXPECT_GT(report.n_items_lost(), 0U);
  try {
    report.finish(estimate(), {}, {});
    ADD_FAILURE() << "a lost file was not told";
  } catch (const drivers::FileError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("tracks.csv"), HasSubstr("No space left"), HasSubstr(".partial")));
  }
  EXPECT_FALSE(fs::exists(path("r/tracks.csv")));
  EXPECT_TRUE(fs::exists(path("r/displacements.csv"))) << "the files that did not fail are complete";
  EXPECT_TRUE(fs::exists(path("r/modal.json")));
}

// A limit on the size of files stands for a disk that fills up half way.
TEST_F(RunReportTest, KeepsWhatFittedAsPartial) {
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  RunReport report = open();
  struct rlimit small = before;
  small.rlim_cur = 300000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  for (std::uint64_t k = 0; k < 2000; ++k) report.add(frame(k, 20));
  std::string message;
  try {
    report.finish(estimate(), {}, {});
  } catch (const drivers::FileError& error) {
    message = error.what();
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr("tracks.csv: writing failed"));
  EXPECT_EQ(fs::file_size(path("r/tracks.csv.partial")), 300000U);
  EXPECT_TRUE(fs::exists(path("r/modal.json")));
}

TEST_F(RunReportTest, RefusesBrokenModalJson) {
  const std::string good = modal_json({"paper", {"base", "roof"}, estimate(), {}, {}});
  const auto refusal = [&](const std::string& from, const std::string& to) -> std::string {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(path("m.json"), std::ios::binary) << text.replace(at, from.size(), to);
    try {
      static_cast<void>(read_modal_json(path("m.json")));
    } catch (const drivers::FileError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal("\"modes\"", "\"models\""), HasSubstr("m.json: modes"));
  EXPECT_THAT(refusal("\"version\": 1", "\"version\": 2"), HasSubstr("version"));
  EXPECT_THAT(refusal("\"frequency_hz\": 1.657", "\"frequency_hz\": null"), HasSubstr("modes[0].frequency_hz"));
  EXPECT_THAT(refusal("\"frequency_hz\": 1.657", "\"frequency_hz\": \"x\""), HasSubstr("no number"));
  EXPECT_THAT(refusal("[0.1, -0.02]", "[0.1]"), HasSubstr("shape.base"));
  EXPECT_THAT(refusal("\"base\": [", "\"bass\": ["), HasSubstr("rejected[0].shape.bass"));
  EXPECT_THAT(refusal("\"structural\"", "\"nice\""), HasSubstr("`nice` is unknown"));
  EXPECT_THAT(refusal("\"samples\": 1500", "\"samples\": -1"), HasSubstr("samples"));
  EXPECT_THAT(refusal("\"fold_n\": -1", "\"fold_n\": 0.5"), HasSubstr("fold_n"));
  EXPECT_THAT(refusal("\"modes\": [", "\"modes\": [7, "), HasSubstr("modes[0]"));
}

}  // namespace
}  // namespace app
