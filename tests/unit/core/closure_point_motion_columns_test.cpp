// PointMotionModel: which columns there are, and what of a known motion each of them gets.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/closure/observation/point_motion_model.h"
#include "core/closure/observation/rungs.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using test_support::kPi;

constexpr Index kFrames = 200;

// A cosine of the record's transform, m half periods: m = 16 is 1 Hz, m = 80 is 5 Hz.
RowVectorXd cosine(int m) {
  RowVectorXd out(kFrames);
  for (Index k = 0; k < kFrames; ++k)
    out(k) = std::cos(kPi * m * (static_cast<double>(k) + 0.5) / static_cast<double>(kFrames));
  return out;
}

// Base and three floors of eight points each, global shutter, still: every frame shows the mean positions.
ObservationRecord still_record() {
  ObservationRecord record = test_support::swaying_record(kFrames, {});
  record.u_px.rowwise() = record.u_px.colwise().mean().eval();
  record.v_px.rowwise() = record.v_px.colwise().mean().eval();
  return record;
}

MatrixXd positions_of(const ObservationRecord& record) {
  MatrixXd out(2 * record.n_points(), record.n_frames());
  for (Index j = 0; j < record.n_points(); ++j) {
    out.row(2 * j) = record.u_px.col(j).transpose();
    out.row(2 * j + 1) = record.v_px.col(j).transpose();
  }
  return out;
}

TEST(PointMotionColumns, AreTheRegionsThenThePlaneAndSpannedOnesFallOut) {
  const PointMotionModel model(still_record());
  EXPECT_EQ(model.first_plane_row(), 4);
  EXPECT_EQ(model.n_own(), 7);     // of the plane: along, across, zoom
  EXPECT_EQ(model.own_rank(), 6);  // all regions together are the translation along their axis
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_EQ(model.row_of_region(2 * r), static_cast<Index>(r));
    EXPECT_EQ(model.row_of_region(2 * r + 1), -1);
  }
}

TEST(PointMotionColumns, ABackgroundHasNoneOfItsOwnButMovesAsAPlane) {
  ObservationRecord record = still_record();
  record.regions[0].role = RegionRole::kBackground;
  const PointMotionModel model(record);
  EXPECT_EQ(model.row_of_region(0), -1);
  EXPECT_EQ(model.first_plane_row(), 3);
  EXPECT_EQ(model.n_own(), 9);
  EXPECT_EQ(model.own_rank(), 8);
}

TEST(PointMotionColumns, ARegionOfBothAxesHasTwo) {
  ObservationRecord record = still_record();
  record.regions[3].both_axes = true;
  const PointMotionModel model(record);
  EXPECT_EQ(model.row_of_region(6), 3);
  EXPECT_EQ(model.row_of_region(7), 4);
}

TEST(PointMotionColumns, EachGetsItsOwnMotionAndNothingIsLeft) {
  const ObservationRecord record = still_record();
  const RowVectorXd across = 3.0 * cosine(10), zoom = 0.01 * cosine(24);
  MatrixXd moved = positions_of(record);
  for (Index j = 0; j < record.n_points(); ++j) {
    const auto floor = static_cast<int>(record.region_of_point[static_cast<std::size_t>(j)]);
    moved.row(2 * j) += (1.0 + floor) * cosine(30 + floor) + (moved(2 * j, 0) - record.cx_px) * zoom;
    moved.row(2 * j + 1) += across + (moved(2 * j + 1, 0) - record.cy_px) * zoom;
  }
  PointMotionModel model(record);
  model.solve(moved, 0.0, 1);
  EXPECT_LT(model.residual_px().cwiseAbs().maxCoeff(), 1e-9);
  for (int floor = 0; floor < 4; ++floor)
    EXPECT_LT((model.amplitudes().row(floor) - (1.0 + floor) * cosine(30 + floor)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((model.amplitudes().row(model.first_plane_row() + 1) - across).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((model.zoom_of_point(5) - zoom).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(model.amplitudes().row(model.first_plane_row()).norm(), 0.0);  // along: dropped
}

TEST(PointMotionColumns, AddedOnesOfTheLowBandEndThere) {
  const ObservationRecord record = still_record();
  VectorXd full = VectorXd::Zero(2 * record.n_points()), low = full;
  for (Index j = 0; j < record.n_points(); ++j) {
    full(2 * j) = j % 2 == 0 ? 1.0 : -1.0;
    low(2 * j + 1) = j % 2 == 0 ? 1.0 : -1.0;
  }
  const RowVectorXd slow = 0.4 * cosine(16), fast = 0.2 * cosine(80);  // 1 and 5 Hz
  PointMotionModel model(record);
  model.set_added({full}, {low}, Rungs(record.rate_hz).up_to(3.0));
  model.solve(positions_of(record) + full * (slow + fast) + low * slow, 0.0, 1);
  EXPECT_LT((model.amplitudes().row(7) - slow - fast).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((model.amplitudes().row(8) - slow).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(model.residual_px().cwiseAbs().maxCoeff(), 1e-9);
  model.solve(positions_of(record) + low * fast, 0.0, 1);
  EXPECT_LT(model.amplitudes().row(8).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(model.residual_px().row(1).cwiseAbs().maxCoeff(), 0.1);
}

}  // namespace
}  // namespace core::closure
