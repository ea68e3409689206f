#include "firmware_app/report/page/report_page.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "firmware_app/report/modal_json.h"
#include "tests/support/made_up_run.h"
#include "tests/support/telemetry_samples.h"
#include "tests/support/xml_fault.h"

namespace app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string page_of(RunData& run) {
  run.inputs.facts = &run.facts;
  return report_html(run.inputs);
}

// Without the part between the first `begin` and the `end` after it.
std::string without(std::string text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin), to = text.find(end, from);
  if (from != std::string::npos && to != std::string::npos) text.erase(from, to + end.size() - from);
  return text;
}

// Parts of HTML unknown to an XML reader: the doctype, the text of style and script, comments.
std::string markup_of(const std::string& page) {
  std::string out = without(without(page, "<style>", "</style>"), "<script>", "</script>");
  for (int i = 0; i < 3; ++i) out = without(out, "<!", ">");
  return out;
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

void expect_sound(const std::string& page) {
  EXPECT_LT(page.size(), 2'000'000U);
  const std::string markup = markup_of(page);
  EXPECT_EQ(test_support::xml_fault(markup), "");
  for (const char* bad : {"nan ", "nan\"", " inf", "\"inf", "-inf"}) EXPECT_THAT(markup, Not(HasSubstr(bad)));
}

void expect_nothing_from_outside(const std::string& page) {
  const std::string name_space = "http://www.w3.org/2000/svg";
  EXPECT_EQ(count_of(page, "http://"), count_of(page, name_space));
  EXPECT_EQ(count_of(page, "https://"), 0U);
  EXPECT_EQ(count_of(page, "src="), 0U);
  EXPECT_EQ(count_of(page, "@import"), 0U);
  EXPECT_EQ(count_of(page, "url("), 0U);
  EXPECT_EQ(count_of(page, "href=\""), count_of(page, "href=\"#") + count_of(page, "href=\"data:image/jpeg;base64,"));
}

// The modes of make_run, the first 2 % lower, the third absent, one more at 20 Hz.
std::shared_ptr<const ModalReport> former_run(std::size_t n_channels) {
  ModalReport out;
  for (std::size_t i = 0; i < n_channels; ++i) out.channel_names.push_back(fmt::format("floor{}", i));
  for (const double hz : {1.657, 5.04, 20.0})
    out.estimate.modes.push_back(made_up_mode(hz, hz, n_channels, core::Verdict::kStructural));
  out.estimate.modes[0].frequency_hz *= 0.98;
  return std::make_shared<const ModalReport>(out);
}

// Text of one section.
std::string section_of(const std::string& page, const char* id) {
  const std::size_t begin = page.find(fmt::format("<section id=\"{}\"", id));
  return begin == std::string::npos ? "" : page.substr(begin, page.find("</section>", begin) - begin);
}

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
}

TEST(ReportPage, TellsWhatTheModelLacks) {
  RunData run;
  make_run(run, 3, 600);
  core::closure::ClosureReport report = tests::sample_closure(2);
  run.inputs.closure = &report;
  report.result.steps[0].rivals = {"a <rival>"};
  std::string page = page_of(run);
  expect_sound(page);
  for (const char* text :
       {"What the model lacks", "Frames 0 to 1499", "readout = 22.5 ± 0.12 ms", "falls from 0.0433 to 0.0312 px",
        "cannot be distinguished from: a &lt;rival&gt;", "in region roof, along u"})
    EXPECT_THAT(section_of(page, "closure"), HasSubstr(text));
  EXPECT_THAT(section_of(page, "closure"), Not(HasSubstr("<table")));  // it was wider than the page
  report.result.steps.clear();
  EXPECT_THAT(page_of(run), HasSubstr("No effect is missing: noise."));
  report.refused = "too <short>";
  page = page_of(run);
  expect_sound(page);
  EXPECT_THAT(page, HasSubstr("The tracks allow no diagnosis: too &lt;short&gt;."));
}

TEST(ReportPage, ComparesTheModesWithAFormerRun) {
  RunData run;
  make_run(run, 4, 600);
  run.inputs.former = former_run(4);
  run.inputs.former_name = "/home/me/<older>/modal.json";
  std::string section = section_of(page_of(run), "comparison");
  // 1.657 ± .003 against 1.624 ± .003 Hz: 2.04 %, .0331 / (.003 sqrt 2) = 7.8 sigmas.
  for (const char* text : {"<p>&lt;older&gt;/modal.json, by 4 channels", ">1.657 ± 0.003 Hz<", ">1.624 ± 0.003 Hz<",
                           ">2.04 %<", ">7.8 σ<", ">1.0000<", "none within 10 %", "Only there: 20.00 Hz."})
    EXPECT_THAT(section, HasSubstr(text));
  run.inputs.former_fault = "<gone>";
  EXPECT_THAT(section_of(page_of(run), "comparison"), HasSubstr("cannot be read: &lt;gone&gt;"));
  run.inputs.former_fault.clear();
  auto renamed = std::make_shared<ModalReport>(*former_run(4));
  renamed->channel_names = {"a", "b", "c", "d"};
  run.inputs.former = renamed;
  section = section_of(page_of(run), "comparison");
  EXPECT_THAT(section, HasSubstr("by 0 channels of the same name"));
  EXPECT_THAT(section, HasSubstr(">0.0000<"));
}

TEST(ReportPage, GivesTheModesAsTextWithTabs) {
  RunData run;
  make_run(run, 2, 600);
  run.estimate.modes[1].damping_std.reset();
  run.estimate.modes[0].shape[1] = kNan;
  const std::string page = page_of(run);
  expect_sound(page);
  EXPECT_THAT(page,
              HasSubstr("mode\tfrequency_hz\tsigma_hz\tdamping_percent\tsigma_percent\tmpc\tapparent_hz\tfloor0 re"));
  EXPECT_THAT(page, HasSubstr("\n1\t1.657\t0.003\t1.02\t0.1\t0.998\t1.657\t0\t0.01\t0.05\t\t"));
  EXPECT_THAT(page, HasSubstr("\n2\t5.04\t0.003\t1.02\t\t0.998\t5.04\t"));
}

TEST(ReportPage, ShowsThePeaksWhereThereIsNoMode) {
  RunData run;
  make_run(run, 3, 600);
  run.estimate.peaks = {{2.5, 0.1, 40.0, {0.2, 1.0, 0.6}}, {7.0, 0.1, 90.0, {1.0, 0.5, 0.1}}};
  EXPECT_THAT(section_of(page_of(run), "modes"), HasSubstr("<details><summary>2 peaks"));
  EXPECT_THAT(section_of(page_of(run), "modes"), HasSubstr("data-label=\"floor1\">1.00<"));
  run.estimate.modes.clear();
  const std::string page = page_of(run);
  expect_sound(page);
  EXPECT_THAT(section_of(page, "modes"), HasSubstr("<h3>2 peaks of the spectra, without a verdict</h3>"));
  EXPECT_THAT(section_of(page, "modes"), HasSubstr("2.500 ± 0.050 Hz"));
  EXPECT_THAT(section_of(page, "operating"), HasSubstr("At 6.9946 Hz"));  // begins at the highest peak
  EXPECT_EQ(count_of(page, "id=\"play\""), 1U);
}

TEST(ReportPage, NamesTheStrongestOfManyChannelsOfAPeak) {
  RunData run;
  make_run(run, 9, 600);
  run.estimate.peaks = {{2.5, 0.1, 40.0, {0.2, 1.0, 0.6, 0.1, 0.3, 0.9, 0.0, 0.5, 0.4}}};
  EXPECT_THAT(section_of(page_of(run), "modes"), HasSubstr("floor1 1.00, floor5 0.90, floor2 0.60, floor7 0.50, …"));
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
