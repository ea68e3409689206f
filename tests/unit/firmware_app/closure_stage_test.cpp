#include "firmware_app/service/stages/closure_stage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/support/swaying_loop.h"

namespace app {
namespace {

using core::closure::ClosureReport;
using core::closure::ObservationRecord;
using test_support::kWindow_s;
using test_support::loop_over;
using test_support::no_geometry;
using test_support::swaying_record;
using test_support::track_frame;
using ::testing::HasSubstr;

// The stage run on a record to its end; its reports, and the corrections that it sends to tracking with
// closure.adopt: auto.
std::vector<ClosureReport> reports_of(const ObservationRecord& record, std::vector<CorrectionSwitch>* changes = nullptr,
                                      CorrectionLog* book = nullptr) {
  rt::SpscRing<ShownFrame> tracks(16, ShownFrame{track_frame(record, 0)});
  rt::SpscRing<ClosureReport> reports(8, ClosureReport{});
  rt::SpscRing<CorrectionSwitch> correction_switches(8, CorrectionSwitch{});
  const bool adopts = changes != nullptr;
  CorrectionLog unused;
  Diagnosis diagnosis(loop_over(record, adopts), book != nullptr ? *book : unused,
                      [&](const CorrectionSet&) { return no_geometry(record); });
  ClosureStage::Ends ends{tracks.reader(), reports.writer()};
  if (adopts) {
    ends.changes.emplace(correction_switches.writer());
    changes->push_back(diagnosis.change());
  }
  ClosureStage stage(std::move(ends), diagnosis);
  auto writer = tracks.writer();
  for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
    *writer.try_claim() = {track_frame(record, k)};
    writer.publish();
    while (stage.step() == rt::StepStatus::kWorked) {
    }
  }
  writer.close();
  rt::StepStatus last = rt::StepStatus::kWorked;
  while (last == rt::StepStatus::kWorked) last = stage.step();
  EXPECT_EQ(last, rt::StepStatus::kFinished);
  stage.finish();
  std::vector<ClosureReport> out;
  auto heard = correction_switches.reader();
  for (; heard.front() != nullptr; heard.pop()) changes->push_back(*heard.front());
  auto reader = reports.reader();
  for (; reader.front() != nullptr; reader.pop()) out.push_back(*reader.front());
  EXPECT_TRUE(reader.finished());
  EXPECT_EQ(stage.stats().n_in.load(), static_cast<std::uint64_t>(record.n_frames()));
  return out;
}

TEST(ClosureStage, ReportsEveryPeriodAndTheRestAtTheEnd) {
  const std::vector<ClosureReport> reports = reports_of(swaying_record(25 * 50, {.roll_rms_rad = 3e-4}));
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports[0].number, 0U);
  EXPECT_EQ(reports[0].first_sequence, 0U);
  EXPECT_EQ(reports[0].last_sequence, 749U);
  EXPECT_FALSE(reports[0].final);
  EXPECT_EQ(reports[1].number, 1U);
  EXPECT_EQ(reports[1].first_sequence, 250U);  // the window is shorter than the run
  EXPECT_EQ(reports[1].last_sequence, 1249U);
  EXPECT_EQ(reports[1].t_stream_ns, 1249 * 40'000'000LL);
  EXPECT_DOUBLE_EQ(reports[1].duration_s, kWindow_s);
  EXPECT_TRUE(reports[1].final);
  for (const ClosureReport& report : reports) {
    EXPECT_EQ(report.refused, "");
    ASSERT_EQ(report.result.steps.size(), 1U);
    EXPECT_EQ(report.result.steps[0].effect, "camera roll");
    EXPECT_GT(report.result.baseline_rms, 1.2 * report.result.residual_rms);
  }
}

TEST(ClosureStage, NamesNothingInTracksThatLackNothing) {
  const std::vector<ClosureReport> reports = reports_of(swaying_record(25 * 32, {}));
  ASSERT_EQ(reports.size(), 1U);  // the remainder after the first is less than half a period
  EXPECT_TRUE(reports[0].result.steps.empty());
  EXPECT_EQ(reports[0].refused, "");
}

TEST(ClosureStage, ARecordTooShortIsRefusedInWords) {
  const std::vector<ClosureReport> reports = reports_of(swaying_record(100, {}));
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_TRUE(reports[0].final);
  EXPECT_THAT(reports[0].refused, HasSubstr("too short"));
}

TEST(ClosureStage, TheSameTracksGiveTheSameBits) {
  const ObservationRecord record = swaying_record(25 * 31, {.k1 = -0.05});
  const std::vector<ClosureReport> one = reports_of(record), other = reports_of(record);
  ASSERT_EQ(one.size(), 1U);
  ASSERT_EQ(one[0].result.steps.size(), other[0].result.steps.size());
  EXPECT_EQ(one[0].result.residual_rms, other[0].result.residual_rms);
  ASSERT_FALSE(one[0].result.steps.empty());
  EXPECT_EQ(one[0].result.steps[0].effect, "radial distortion");
  EXPECT_EQ(one[0].result.steps[0].parameters[0].value, other[0].result.steps[0].parameters[0].value);
}

TEST(ClosureStage, AdoptsWhatTwoReportsAgreeOnAndTellsTrackingOncePerReport) {
  std::vector<CorrectionSwitch> changes;
  CorrectionLog book;
  const std::vector<ClosureReport> reports = reports_of(swaying_record(25 * 95, {.k1 = -0.05}), &changes, &book);
  ASSERT_EQ(reports.size(), 3U);
  EXPECT_TRUE(reports[0].changes.empty());
  ASSERT_EQ(reports[1].changes.size(), 1U);
  EXPECT_THAT(reports[1].changes[0], HasSubstr("from frame 1750 on taken out, radial distortion: k1 = -0.0"));
  ASSERT_EQ(reports[2].in_force.size(), 1U);
  ASSERT_EQ(changes.size(), 4U);  // before any frame, and after each report
  EXPECT_EQ(changes[0].next_report_at, 749U);
  EXPECT_EQ(changes[0].n_delay_frames, 250U);
  EXPECT_EQ(changes[1].next_report_at, 1499U);
  EXPECT_EQ(changes[1].geometry, nullptr);
  ASSERT_NE(changes[2].geometry, nullptr);
  EXPECT_EQ(changes[2].from_sequence, 1750U);
  EXPECT_EQ(changes[2].correction_set, 1U);
  EXPECT_EQ(changes[3].geometry, nullptr);
  const CorrectionSet& correction_set = book.at(1);
  EXPECT_NEAR(correction_set.places.lens.distortion[0], -0.05, 0.002);
  EXPECT_TRUE(correction_set.places.in_keyframe);  // the lens existed from the first frame on
  EXPECT_EQ(correction_set.words.size(), 1U);
}

TEST(ClosureStage, WithoutAnEffectNothingIsAdopted) {
  std::vector<CorrectionSwitch> changes;
  CorrectionLog book;
  const std::vector<ClosureReport> reports = reports_of(swaying_record(25 * 62, {}), &changes, &book);
  for (const ClosureReport& report : reports) EXPECT_TRUE(report.changes.empty());
  for (const CorrectionSwitch& change : changes) EXPECT_EQ(change.geometry, nullptr);
}

}  // namespace
}  // namespace app
