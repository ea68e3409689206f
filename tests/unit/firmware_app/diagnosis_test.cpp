#include "firmware_app/chain/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/support/swaying_loop.h"

namespace app {
namespace {

using core::closure::ClosureReport;
using test_support::loop_over;
using test_support::no_geometry;
using test_support::swaying_record;
using test_support::track_frame;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// An undeclared lens; two reports agree on it.
const core::closure::ObservationRecord& bent_record() {
  static const core::closure::ObservationRecord record = swaying_record(25 * 62, {.k1 = -0.05});
  return record;
}

struct Told {
  ClosureReport report;
  CorrectionSwitch change;
};

std::vector<Told> told_by(CorrectionLog& book, const Diagnosis::MakeGeometry& make, std::uint64_t n_frames = 0) {
  const auto& record = bent_record();
  MissingEffectSearchConfig config = loop_over(record, true);
  config.n_frames = n_frames;
  Diagnosis diagnosis(std::move(config), book, make);
  std::vector<Told> out;
  for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
    diagnosis.take(track_frame(record, k), 1);
    if (!diagnosis.is_due()) continue;
    ClosureReport report = diagnosis.report(false);
    out.push_back({std::move(report), diagnosis.change()});
  }
  return out;
}

TEST(Diagnosis, WhatTwoReportsAgreeOnIsInTheBookAndChangesTheGeometry) {
  CorrectionLog book;
  const auto told = told_by(book, [](const CorrectionSet&) { return no_geometry(bent_record()); });
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].change.geometry, nullptr);
  EXPECT_NE(told[1].change.geometry, nullptr);
  EXPECT_EQ(told[1].change.correction_set, 1U);
  EXPECT_EQ(book.newest().words, told[1].report.in_force);
  EXPECT_EQ(told[1].report.in_force.size(), 1U);
}

TEST(Diagnosis, NothingBeginsAfterTheLastFrameOfARecording) {
  CorrectionLog book;
  const auto make = [](const CorrectionSet&) { return no_geometry(bent_record()); };
  // The second report comes at frame 1499 and would change frames from 1750 on.
  const auto told = told_by(book, make, static_cast<std::uint64_t>(bent_record().n_frames()));
  ASSERT_EQ(told.size(), 2U);
  EXPECT_TRUE(told[1].report.changes.empty());
  EXPECT_TRUE(told[1].report.in_force.empty());
  EXPECT_EQ(told[1].change.geometry, nullptr);
  EXPECT_EQ(book.newest().number, 0U);
}

TEST(Diagnosis, TheLastReportOfARunOmitsWhatNeverBegan) {
  CorrectionLog book;
  const auto& record = bent_record();
  Diagnosis diagnosis(loop_over(record, true), book, [](const CorrectionSet&) { return no_geometry(bent_record()); });
  for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
    diagnosis.take(track_frame(record, k), 1);
    if (diagnosis.is_due()) (void)diagnosis.report(false);
  }
  EXPECT_EQ(book.newest().number, 1U);
  EXPECT_TRUE(diagnosis.report(true).in_force.empty()) << "the record ends 200 frames before the correction";
}

TEST(Diagnosis, WithAFullBookNothingChangesAndTheReportSaysSo) {
  CorrectionLog book;
  while (!book.full()) {
    CorrectionSet before;
    before.words = {"what was there before"};
    book.add(before);
  }
  const auto told = told_by(book, [](const CorrectionSet&) { return no_geometry(bent_record()); });
  ASSERT_EQ(told.size(), 2U);
  ASSERT_EQ(told[1].report.changes.size(), 2U);
  EXPECT_EQ(told[1].report.changes[1], "none of this is done: too many changes in one run");
  EXPECT_EQ(told[1].change.geometry, nullptr);
  EXPECT_THAT(told[1].report.in_force, ElementsAre("what was there before"));
  EXPECT_EQ(told[1].change.next_report_at, 2249U) << "the next report is due as ever";
}

TEST(Diagnosis, AGeometryThatCannotBeMadeChangesNothingAndTheReportSaysWhy) {
  CorrectionLog book;
  const auto told = told_by(
      book, [](const CorrectionSet&) -> std::unique_ptr<Geometry> { throw std::runtime_error("no such lens"); });
  ASSERT_EQ(told.size(), 2U);
  ASSERT_EQ(told[1].report.changes.size(), 2U);
  EXPECT_THAT(told[1].report.changes[1], HasSubstr("none of this is done: no such lens"));
  EXPECT_EQ(told[1].change.geometry, nullptr);
  EXPECT_TRUE(told[1].report.in_force.empty());
  EXPECT_EQ(book.newest().number, 0U);
}

}  // namespace
}  // namespace app
