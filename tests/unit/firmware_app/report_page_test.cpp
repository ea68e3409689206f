#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "tests/support/report_page_text.h"
#include "tests/support/telemetry_samples.h"

namespace app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ReportPage, ShowsAllOfACompleteRun) {
  RunData run;
  make_run(run, 7, 1500);
  fill_frame(run, 1920, 1080);
  run.facts.source = "clip.mp4", run.facts.method = "hovermodal", run.facts.corrections = {"lens distortion"};
  const core::closure::ClosureReport closure = tests::sample_closure(1);
  run.inputs.closure = &closure;
  run.inputs.former = former_run(7);
  run.facts.title = "Old bridge", run.facts.notes = {"place: the <river>", "wind from the west"};
  const std::string page = page_of(run);
  expect_sound(page);
  expect_nothing_from_outside(page);
  for (const char* text : {"clip.mp4",
                           "<h1>Old bridge</h1>",
                           "<dt>place</dt><dd>the &lt;river&gt;</dd>",
                           "<p class=\"user-note\">wind from the west</p>",
                           "MAC of every pair of modes",
                           "Singular values of the spectral matrix",
                           "id=\"deflection\" data-hz=",
                           "data-via=",
                           "3 modes of the structure were found, from 1.657 to 12.93 Hz",
                           "12.93 ± 0.003 Hz",
                           "seen at 12.07 Hz",
                           "1.02 ± 0.10 %",
                           "structural",
                           "camera motion",
                           "input peak",
                           "lens distortion",
                           "20 of 1520 frames were lost",
                           "Stabilisation diagram",
                           "Fold map",
                           "Scale over time",
                           "Track quality",
                           "Convergence",
                           "%/min, drifts",
                           "All 3 modes together",
                           "alias order changed 1 times",
                           "4.0 min",
                           "mode 2: 5.040 Hz",
                           "Frames missing",
                           "7.654 ms",
                           "class=\"move\"",
                           "class=\"whisker\"",
                           "data-read=\"poles\"",
                           "prefers-reduced-motion"})
    EXPECT_THAT(page, HasSubstr(text)) << text;
  EXPECT_THAT(page, Not(HasSubstr("class=\"absent\"")));
  EXPECT_EQ(count_of(page, "data:image/jpeg"), 1U);  // the frame is contained once
}

TEST(ReportPage, GivesTheSameBytesButForTheTiming) {
  std::string pages[2];
  for (int i = 0; i < 2; ++i) {
    RunData run;
    make_run(run, 3, 500);
    run.facts.health.stages[0].busy_ns += static_cast<std::uint64_t>(i) * 12'345'678'901;
    run.facts.health.messages_sent = 100 + static_cast<std::uint64_t>(i);
    pages[i] = page_of(run);
  }
  EXPECT_NE(pages[0], pages[1]);
  EXPECT_EQ(without(pages[0], kVariesBegin, kVariesEnd), without(pages[1], kVariesBegin, kVariesEnd));
}

TEST(ReportPage, TellsWhyASectionIsMissing) {
  RunData run;
  run.facts.counted = false;
  run.estimate.status = "the record is <short>";
  run.inputs.estimate = &run.estimate;
  const std::string page = page_of(run);
  expect_sound(page);
  expect_nothing_from_outside(page);
  EXPECT_THAT(page, HasSubstr("No mode of the structure was found: the record is &lt;short&gt;."));
  for (const char* id :
       {"modes", "shapes", "mac", "comparison", "singular", "operating", "spectra", "folds", "stabilisation",
        "convergence", "displacements", "scale", "quality", "frame-view", "closure", "losses", "timing"}) {
    const std::size_t begin = page.find(std::string("<section id=\"") + id + "\"");
    ASSERT_NE(begin, std::string::npos) << id;
    EXPECT_THAT(page.substr(begin, page.find("</section>", begin) - begin), HasSubstr("class=\"absent\"")) << id;
  }
  EXPECT_EQ(count_of(page, "class=\"plot"), 0U);
  EXPECT_THAT(section_of(page, "spectra"), HasSubstr("the record ended before its first segment was full"));
  run.facts.merged = true;
  EXPECT_THAT(section_of(page_of(run), "spectra"), HasSubstr("A merged result has no spectrum of its own"));
  EXPECT_THAT(section_of(page_of(run), "singular"), HasSubstr("has no singular values of its own"));
  EXPECT_THAT(section_of(page_of(run), "operating"), HasSubstr("has no shape at a frequency of its own"));
}

TEST(ReportPage, ATimeSeriesHasNoPictureButItsShapes) {
  RunData run;
  make_run(run, 5, 800);
  run.inputs.regions.clear(), run.inputs.first_frame = nullptr, run.inputs.keyframe = nullptr;
  run.facts.counted = false;
  const std::string page = page_of(run);
  expect_sound(page);
  EXPECT_THAT(page, HasSubstr("there is no picture of the structure"));
  EXPECT_THAT(page, Not(HasSubstr("class=\"move\"")));
  EXPECT_EQ(count_of(page, "class=\"card\""), 3U);
}

TEST(ReportPage, EscapesHostileNames) {
  const std::string hostile = "</script><script>alert(1)</script>\"'&<img src=x>\x01\xFF";
  RunData run;
  make_run(run, 3, 300);
  for (auto& channel : run.inputs.channels) channel.name = hostile;
  for (auto& region : run.inputs.regions) region.name = hostile;
  run.facts.source = run.facts.method = hostile;
  run.facts.corrections = {hostile};
  run.facts.title = hostile, run.facts.notes = {hostile, "place: " + hostile};
  run.inputs.former = former_run(3), run.inputs.former_name = hostile;
  run.facts.health.state = "fault: " + hostile;
  run.facts.health.warnings = {hostile};
  run.facts.health.stages[0].name = hostile;
  run.estimate.modes[0].reason = run.estimate.rejected[0].reason = hostile;
  const std::string page = page_of(run);
  expect_sound(page);
  EXPECT_EQ(count_of(page, "<script"), 1U);
  EXPECT_EQ(count_of(page, "<img"), 0U);
  EXPECT_EQ(count_of(page, "\x01") + count_of(page, "\xFF"), 0U);
  EXPECT_THAT(page, HasSubstr("fault: &lt;/script&gt;"));
}

TEST(ReportPage, StaysBelowTwoMegabytesWith64ChannelsAnHourAndManyModes) {
  RunData run;
  make_run(run, 64, 90'000);
  fill_frame(run, 3840, 2160);  // noise: the worst case for compression
  for (int i = 0; i < 40; ++i)
    run.estimate.modes.push_back(made_up_mode(6.0 + 0.1 * i, 6.0 + 0.1 * i, 64, core::Verdict::kStructural));
  for (int i = 0; run.estimate.poles.size() < core::kMaxStabilisationPoles; ++i)
    run.estimate.poles.push_back({16 + i % 90, 0.003 * i, 0.003 * i, 0.01, 0.5, i % 44});
  const std::string page = page_of(run);
  expect_sound(page);
  EXPECT_THAT(page, HasSubstr("39 more modes are in the table above only"));
}

TEST(ReportPage, SurvivesValuesThatAreNotFiniteAndListsThatDoNotMatch) {
  RunData run;
  make_run(run, 4, 60);
  run.estimate.modes[0].frequency_hz = kNan, run.estimate.modes[0].shape[1] = kNan;
  run.estimate.modes[1].shape.resize(2), run.estimate.modes[1].apparent_hz = kNan, run.estimate.modes[1].mpc = kNan;
  run.estimate.modes[2].damping_std = kNan, run.estimate.modes[2].shape_std.assign(9, 1e300);
  run.estimate.poles[0].apparent_hz = run.estimate.poles[1].mpc = kNan;
  run.estimate.poles[2].i_line = 99;
  run.inputs.channels[3].region = 77;
  run.keyframe.points[0].u_px = kNan;
  run.spectrum.data_sum[40] = kNan;
  run.inputs.regions[1].width_px = 0.0;
  expect_sound(page_of(run));
  run.spectrum.data_sum.resize(3), run.frame.pixels.resize(5), run.estimate.rate_hz = 0.0;
  expect_sound(page_of(run));
}

TEST(ReportPage, AFaultIsToldAtTheTop) {
  RunData run;
  make_run(run, 2, 100);
  run.facts.health.state = "fault: camera: cable pulled";
  const std::string page = page_of(run);
  EXPECT_LT(page.find("cable pulled"), page.find("<nav"));
}

}  // namespace
}  // namespace app
