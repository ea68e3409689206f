#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "tests/support/report_page_text.h"
#include "tests/support/telemetry_samples.h"

// What the page says about modes, peaks, effects, and beside a former run.
namespace app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(ReportPage, ComparesTheModesWithAFormerRun) {
  RunData run;
  make_run(run, 4, 600);
  run.inputs.former = former_run(4);
  run.inputs.former_name = "runs/<older>/modal.json";
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

}  // namespace
}  // namespace app
