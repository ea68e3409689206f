#include "core/closure/observation/point_motion_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <vector>

#include "core/closure/noise_stream.h"
#include "tests/support/swaying_record.h"

namespace core::closure {
namespace {

using test_support::kPi;

constexpr Eigen::Index kFrames = 800;
constexpr double kNoise_px = 0.005, kRate_hz = 25.0;

// Observations of points whose motion is known at every instant, each at the instant of its own row.
struct View {
  double readout_frames = 0.9;
  double mode_hz = 1.7;                                 // of the structure, in proportion to the floor
  std::vector<std::array<double, 3>> along_u, along_v;  // of the camera: px, Hz, phase
  double zoom = 0.0;                                    // relative, at 0.4 Hz
  double second_mode_hz = 0.0;                          // 0.5 px, floors 1 and 3 against floor 2; 0: none
  Eigen::Index n_frames = kFrames;

  [[nodiscard]] static double sum(const std::vector<std::array<double, 3>>& sines, double t) {
    double out = 0.0;
    for (const auto& [px, hz, phase] : sines) out += px * std::sin(2.0 * kPi * hz * t + phase);
    return out;
  }

  [[nodiscard]] ObservationRecord record() const {
    ObservationRecord r = test_support::swaying_record(n_frames, {});
    r.readout_frames = readout_frames;
    r.sigma_px.assign(r.sigma_px.size(), kNoise_px);
    const Eigen::RowVectorXd u = r.u_px.colwise().mean(), v = r.v_px.colwise().mean();
    NoiseStream noise(4);
    for (Eigen::Index j = 0; j < r.n_points(); ++j) {
      const auto floor = static_cast<double>(r.region_of_point[static_cast<std::size_t>(j)]);
      const double second = second_mode_hz == 0.0 || floor == 0.0 ? 0.0 : floor == 2.0 ? -0.5 : 0.5;
      for (Eigen::Index k = 0; k < n_frames; ++k) {
        double seen_u = u(j), seen_v = v(j);
        for (int round = 0; round < 4; ++round) {  // the row depends on where the point is at its instant
          const double t = (static_cast<double>(k) + readout_frames * seen_v / r.height_px) / r.rate_hz;
          const double scale = 1.0 + zoom * std::sin(2.0 * kPi * 0.4 * t);
          const double sway =
              0.5 * floor * std::sin(2.0 * kPi * mode_hz * t) + second * std::sin(2.0 * kPi * second_mode_hz * t);
          seen_u = r.cx_px + scale * (u(j) - r.cx_px) + sum(along_u, t) + sway;
          seen_v = r.cy_px + scale * (v(j) - r.cy_px) + sum(along_v, t);
        }
        r.u_px(k, j) = seen_u + kNoise_px * noise.gaussian();
        r.v_px(k, j) = seen_v + kNoise_px * noise.gaussian();
      }
    }
    return r;
  }
};

struct Solved {
  double residual = 0.0;  // rms in sigmas, relative to the noise
  Eigen::MatrixXd amplitudes;
};

// In one place: parts of the model refer to it.
std::unique_ptr<PointMotionModel> solved_model(const ObservationRecord& record) {
  const Eigen::Index n = record.n_frames();
  Eigen::MatrixXd positions(2 * record.n_points(), n), later(record.n_points(), n);
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    positions.row(2 * j) = record.u_px.col(j).transpose();
    positions.row(2 * j + 1) = record.v_px.col(j).transpose();
    later.row(j) = (record.v_px.col(j).array() - record.v_px.col(j).mean()).transpose() / record.height_px;
  }
  auto model = std::make_unique<PointMotionModel>(record);
  model->set_drift(later);
  model->solve(positions, record.readout_frames, 1);
  return model;
}

Solved solve(const ObservationRecord& record) {
  const auto solved = solved_model(record);
  const PointMotionModel& model = *solved;
  const Eigen::Index n = record.n_frames();
  constexpr Eigen::Index kEnds = 30;  // frames that are continued by reflection
  const Eigen::MatrixXd inner = model.residual().middleCols(kEnds, n - 2 * kEnds);
  const double freedom = 1.0 - static_cast<double>(model.q_high().cols()) / static_cast<double>(model.q_high().rows());
  return {std::sqrt(inner.squaredNorm() / static_cast<double>(inner.size()) / freedom), model.amplitudes()};
}

// Camera motion of 8 px at 0.14 Hz, with decreasing amplitudes up to 11 Hz.
TEST(PointMotionModel, CameraMotionOfAnySpectrumUpToHalfTheRateLeavesNoiseOnly) {
  View view;
  view.zoom = 0.01;
  view.along_u = {{8.0, 0.14, 0.0}, {1.0, 1.1, 2.0}, {0.3, 3.7, 1.0}, {0.2, 8.3, 4.0}, {0.1, 11.1, 0.5}};
  view.along_v = {{5.0, 0.11, 1.0}, {0.8, 0.9, 3.0}, {0.3, 4.1, 0.0}, {0.2, 7.7, 1.0}, {0.1, 10.9, 2.5}};
  const double residual = solve(view.record()).residual;
  EXPECT_LT(residual, 1.02);
  EXPECT_GT(residual, 0.9);  // motion that may belong to that tail has less weight
}

TEST(PointMotionModel, AmplitudesAreThoseOfTheMeanRow) {
  View view;
  view.mode_hz = 9.0;
  const ObservationRecord record = view.record();
  const Eigen::MatrixXd amplitudes = solve(record).amplitudes;
  for (Eigen::Index floor = 1; floor < 4; ++floor) {
    const double row = record.v_px.middleCols(8 * floor, 8).mean() / record.height_px;
    double worst = 0.0;
    for (Eigen::Index k = 60; k < kFrames - 60; ++k) {
      const double t = (static_cast<double>(k) + view.readout_frames * row) / kRate_hz;
      worst = std::max(worst, std::abs(amplitudes(floor, k) -
                                       0.5 * static_cast<double>(floor) * std::sin(2.0 * kPi * view.mode_hz * t)));
    }
    EXPECT_LT(worst, 0.03) << floor;
  }
}

// 16.3 Hz at 25 frames/s appears at 8.7 Hz, with the row-to-row phases of 16.3 Hz.
TEST(PointMotionModel, AModeThatFoldsLeavesNoiseOnly) {
  View view;
  view.mode_hz = 16.3;  // of 100 ... 300 times the noise
  const double residual = solve(view.record()).residual;
  EXPECT_LT(residual, 1.5);  // of 20 with the phases of 8.7 Hz
  EXPECT_GT(residual, 0.9);
}

// The transform of 1100 frames continues them by almost as many.
TEST(PointMotionModel, AModeThatFoldsLeavesNoiseOnlyInARecordOfAnyLength) {
  View view;
  view.mode_hz = 16.3;
  view.n_frames = 1100;
  EXPECT_LT(solve(view.record()).residual, 1.5);
}

// Both appear in one strip of the spectrum: 16.3 Hz at 8.7 Hz.
TEST(PointMotionModel, AModeThatFoldsBesideOneThatDoesNotLeavesNoiseOnly) {
  View view;
  view.mode_hz = 16.3;
  view.second_mode_hz = 8.55;
  EXPECT_LT(solve(view.record()).residual, 1.5);
  view.second_mode_hz = 8.9;
  EXPECT_LT(solve(view.record()).residual, 1.5);
}

// The power-law tail of a hover on both sides of half the rate, f^-4: a spectral line in every bin of the record's
// spectrum from 6 to 22 Hz, 0.05 px together above 12.5 Hz.
View view_with_tail() {
  constexpr double kStep_hz = kRate_hz / static_cast<double>(kFrames);
  View view;
  for (int i = 0; i < 512; ++i) {
    const double hz = 6.0 + kStep_hz * i, px = 0.0055 * std::pow(12.5 / hz, 2.0);
    view.along_u.push_back({px, hz, 2.4 * i * i});
    view.along_v.push_back({px, hz, 3.9 * i * i});
  }
  return view;
}

TEST(PointMotionModel, TheTailOfTheCamerasMotionIsNotLeftInTheResidual) {
  const double residual = solve(view_with_tail().record()).residual;
  EXPECT_LT(residual, 1.06);
  EXPECT_GT(residual, 0.8);
}

// What a motion at one frequency leaves: as a series, which is weighted over its whole spectrum, and as a field.
TEST(PointMotionModel, AFieldIsWeightedLikeTheSeriesOfItsMotion) {
  constexpr double kField_hz = 9.0;
  constexpr Eigen::Index kEnds = 100;
  const ObservationRecord record = view_with_tail().record();
  const auto solved = solved_model(record);
  const PointMotionModel& model = *solved;
  Eigen::VectorXd field(2 * record.n_points());  // a translation whose phase differs between the rows: the tail's
  for (Eigen::Index i = 0; i < field.size(); ++i)
    field(i) = i % 2 == 0 ? std::sin(2.0 * kPi * record.readout_frames * model.geometry().share(i / 2)) : 0.0;
  Eigen::RowVectorXd course(kFrames);
  for (Eigen::Index k = 0; k < kFrames; ++k)
    course(k) = std::cos(2.0 * kPi * kField_hz / kRate_hz * static_cast<double>(k));
  const Eigen::MatrixXd series = model.left_at_common_instants(model.at_own_instants(field * course));
  const Eigen::VectorXd whitened = model.whitened(field);
  const Eigen::VectorXd left = model.left_at(kField_hz, whitened.cast<std::complex<double>>()).real();
  const Eigen::VectorXd unweighted = whitened - model.q_high() * (model.q_high().transpose() * whitened);
  const Eigen::MatrixXd expected = left * course;
  const Eigen::Index n_inner = kFrames - 2 * kEnds;
  EXPECT_LT((series - expected).middleCols(kEnds, n_inner).norm(), 0.05 * expected.middleCols(kEnds, n_inner).norm());
  EXPECT_LT(left.norm(), 0.8 * unweighted.norm());
}

}  // namespace
}  // namespace core::closure
