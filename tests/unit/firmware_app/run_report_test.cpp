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
#include "drivers/storage/tracks_file.h"
#include "firmware_app/report/modal_json.h"
#include "tests/support/run_report_fixture.h"
#include "tests/support/track_frames.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

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
  const std::vector<core::TrackFrame> read = tests::frames_of(back);
  ASSERT_EQ(read.size(), frames.size());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    EXPECT_EQ(read[k].sequence, frames[k].sequence);
    EXPECT_EQ(read[k].t_start_ns, frames[k].t_start_ns);
    std::size_t i_back = 0;
    for (const core::TrackPoint& point : frames[k].points) {
      if (!point.seen) continue;
      ASSERT_LT(i_back, read[k].points.size());
      const core::TrackPoint& p = read[k].points[i_back++];
      EXPECT_EQ(p.id, point.id);
      EXPECT_EQ(p.region, point.region);
      EXPECT_NEAR(p.u_px, point.u_px, 5.0001e-5);
      EXPECT_NEAR(p.v_px, point.v_px, 5.0001e-5);
      EXPECT_NEAR(p.sigma_px, point.sigma_px, 5.0001e-6);
    }
    EXPECT_EQ(i_back, read[k].points.size()) << "a lost point has a line";
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

TEST_F(RunReportTest, WhatTheAircraftStatedComesBackFromModalJson) {
  app::ModalReport report{"hovermodal", {"base", "roof"}, estimate(), {}, {}};
  EXPECT_THAT(modal_json(report), Not(HasSubstr("aircraft")));
  report.aircraft.n_states = 118;
  report.aircraft.motors = {{1, 95.25, 0.04}, {3, 97.5, 0.0}};
  report.aircraft.place = core::AircraftSummary::Place{-33.25, 151.5, std::nullopt};
  report.aircraft.wind = core::AircraftSummary::Wind{4.5, 310.0};
  const std::string text = modal_json(report);
  std::ofstream(path("modal.json")) << text;
  const core::AircraftSummary back = app::read_modal_json(path("modal.json")).aircraft;
  EXPECT_EQ(back.n_states, 118U);
  ASSERT_EQ(back.motors.size(), 2U);
  EXPECT_EQ(back.motors[1].number, 3);
  EXPECT_EQ(back.motors[0].hz, 95.25);
  EXPECT_EQ(back.motors[0].spread_hz, 0.04);
  ASSERT_TRUE(back.place && back.wind);
  EXPECT_EQ(back.place->latitude_deg, -33.25);
  EXPECT_FALSE(back.place->above_home_m);
  EXPECT_EQ(back.wind->from_deg, 310.0);

  std::string wrong = text;
  wrong.replace(wrong.find("97.5"), 4, "-7.5");
  std::ofstream(path("modal.json")) << wrong;
  try {
    (void)app::read_modal_json(path("modal.json"));
    FAIL() << "taken";
  } catch (const drivers::FileError& refused) {
    EXPECT_THAT(refused.what(), HasSubstr("aircraft.hz: is no number from 1 to 2000"));
  }
}

TEST_F(RunReportTest, ModalJsonHasExactlyTheAgreedLayout) {
  core::Health losses;
  losses.frames_in = 10, losses.frames_processed = 9, losses.frames_dropped = 1;
  const std::string text =
      modal_json({"paper", {"base", "roof"}, estimate(), {"camera roll"}, losses, {"an oblique view"}});
  EXPECT_EQ(text, R"({
  "version": 1,
  "method": "paper",
  "rate_hz": 25,
  "duration_s": 60,
  "samples": 1500,
  "segments": 4,
  "remembered_s": 0,
  "degrees_of_freedom": null,
  "resolution_hz": null,
  "channels": [],
  "modes": [
    {
      "frequency_hz": 1.657,
      "frequency_std_hz": 0.002,
      "apparent_hz": 1.657,
      "fold_n": null,
      "fold_margin": null,
      "may_be_hz": [],
      "damping_ratio": 0.01,
      "damping_std": null,
      "damping_interval_95": null,
      "shape": {
        "base": [0.1, -0.02],
        "roof": [1, 0]
      },
      "shape_real": {
        "base": 0.10198039027185571,
        "roof": 1
      },
      "shape_std": null,
      "mpc": 0.99,
      "emac": 0.9,
      "cmi": 0.891,
      "verdict": "structural",
      "reason": "present in 14 of 15 orders",
      "history": {
        "id": 2,
        "estimates": 5,
        "first_estimate": 1,
        "first_seen_s": 30,
        "fold_changes": 0,
        "drift_hz_per_s": -0.0005,
        "drift_std_hz_per_s": 0.000125,
        "drifts": true,
        "more_s": 120.5
      }
    }
  ],
  "rejected": [
    {
      "frequency_hz": 1.657,
      "frequency_std_hz": 0.002,
      "apparent_hz": 1.657,
      "fold_n": -1,
      "fold_margin": 0.25,
      "may_be_hz": [],
      "damping_ratio": 0.01,
      "damping_std": null,
      "damping_interval_95": null,
      "shape": {
        "base": [0.1, -0.02],
        "roof": [1, 0]
      },
      "shape_real": {
        "base": 0.10198039027185571,
        "roof": 1
      },
      "shape_std": {
        "base": 0.1,
        "roof": 0.2
      },
      "mpc": 0.99,
      "emac": 0.9,
      "cmi": 0.891,
      "verdict": "numerical",
      "reason": "present in 14 of 15 orders",
      "history": null
    }
  ],
  "peaks": [],
  "readout": null,
  "corrections": [
    "camera roll"
  ],
  "caveats": [
    "an oblique view"
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

TEST_F(RunReportTest, OnlyThePapersShapesAreGivenAsRealOnesToo) {
  EXPECT_THAT(modal_json({"hovermodal", {"base", "roof"}, estimate(), {}, {}}), Not(HasSubstr("shape_real")));
}

TEST_F(RunReportTest, ModalJsonComesBackAsItWas) {
  RunReport report = open();
  core::Health losses;
  losses.frames_missing = 3;
  core::ModalEstimate found = estimate();
  found.readout = core::ReadoutFinding{{0.026, 0.001},
                                       {0.025, 0.0005},
                                       core::ReadoutValue{0.0249, 0.0006},
                                       {},
                                       true,
                                       "declared and estimated from the tracks"};
  report.finish(found, losses, {"camera roll"});
  const ModalReport back = read_modal_json(path("r/modal.json"));
  EXPECT_EQ(back.method, "hovermodal");
  EXPECT_THAT(back.channel_names, ElementsAre("base", "roof"));
  EXPECT_EQ(modal_json(back), text_of(path("r/modal.json")));
  ASSERT_TRUE(back.estimate.readout && back.estimate.readout->from_tracks);
  EXPECT_DOUBLE_EQ(back.estimate.readout->from_tracks->readout_s, 0.0249);
  EXPECT_FALSE(back.estimate.readout->from_shapes.has_value());
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
  EXPECT_EQ(drivers::read_tracks_csv(path("r/tracks.csv")).first.points.size(), 2U);
}

TEST_F(RunReportTest, ARecoveredRunSaysSo) {
  for (const bool is_recovered : {false, true}) {
    RunReport report = open();
    if (is_recovered) report.set_recovered();
    EXPECT_TRUE(report.add(frame(0, 3)));
    EXPECT_TRUE(report.add(sample(0)));
    report.finish(estimate(), {}, {});
    EXPECT_EQ(text_of(path("r/modal.json")).find("\"recovered\": true") != std::string::npos, is_recovered);
    EXPECT_EQ(read_modal_json(path("r/modal.json")).recovered, is_recovered);
  }
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

}  // namespace
}  // namespace app
