#include "core/identification/camera_leakage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <random>

#include "core/identification/identifier.h"
#include "core/identification/mac.h"
#include "tests/support/simulated_structure.h"

namespace core {
namespace {

using test_support::SimulatedStructure;

constexpr double kRate_hz = 30.0, kDuration_s = 300.0;
constexpr double kGain = 1.9;  // the witness is that much farther away than the structure

// The frame's floors seen by a camera that translates, and a wall behind it: sums of base, six floors and the wall.
// camera(k): camera translation as the wall shows it, mm; wall(response, t): the wall's own motion.
struct Filmed {
  std::function<double(int)> camera;
  std::function<double(const simulation::StructureResponse&, double)> wall;

  [[nodiscard]] CpsdSums spectra(bool with_witness) const {
    SimulatedStructure frame;
    const simulation::StructureResponse response(frame.scene.structure, frame.scene.excitation, 1, kDuration_s + 1.0);
    const int n = frame.n_channels();
    WelchConfig config;
    config.n_channels = n + (with_witness ? 1 : 0);
    config.segment = 1024;
    config.rate_hz = kRate_hz;
    WelchCpsd welch(config);
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise_mm(0.0, 0.01);
    DisplacementSample sample;
    sample.value_mm.resize(static_cast<std::size_t>(n));
    sample.seen.assign(sample.value_mm.size(), 1);
    sample.witness_mm.resize(with_witness ? 1 : 0);
    sample.witness_seen.assign(sample.witness_mm.size(), 1);
    for (int k = 0; k < static_cast<int>(kDuration_s * kRate_hz); ++k) {
      const double t = k / kRate_hz, shift_mm = camera(k);
      for (int c = 0; c < n; ++c) {
        sample.value_mm[static_cast<std::size_t>(c)] =
            response.displacement_mm(c, t) + kGain * shift_mm + noise_mm(random);
      }
      const double wall_mm = shift_mm + wall(response, t) + noise_mm(random);
      if (with_witness) sample.witness_mm[0] = wall_mm;
      (void)welch.push(sample);
    }
    welch.flush();
    return welch.sums();
  }
  [[nodiscard]] ModalEstimate identified(bool with_witness) const {
    std::vector<ChannelInfo> channels = SimulatedStructure{}.channels();
    channels[0].is_base =
        false;  // given a base, the static region is an input beside it (identification_given_inputs_test)
    if (with_witness) {
      channels.emplace_back();
      channels.back().name = "wall";
      channels.back().is_witness = true;
    }
    return Identifier({}, channels).identify(spectra(with_witness));
  }
};

double at_rest(const simulation::StructureResponse&, double) { return 0.0; }

// Hover: falls with the square of the frequency.
std::function<double(int)> hover(double rms_mm) {
  return [=, random = std::mt19937_64(2), force = 0.0, shift = 0.0](int) mutable {
    constexpr double kMemory = 0.9, kRms = 16.4;  // of both filters in a row, of unit noise
    force = kMemory * force + std::normal_distribution<double>()(random);
    shift = kMemory * shift + force;
    return rms_mm / kRms * shift;
  };
}

// 1 - MAC with the truth of the modes below 10 Hz: the worst.
double worst_shape(const ModalEstimate& estimate, std::size_t* n_found = nullptr) {
  SimulatedStructure frame;
  const Eigen::MatrixXd shapes = simulation::shear_chain_shapes(6);
  double worst = 0.0;
  std::size_t found = 0;
  for (Eigen::Index r = 0; r < 3; ++r) {
    const std::vector<std::complex<double>> truth(shapes.col(r).begin(), shapes.col(r).end());
    for (const Mode& mode : estimate.modes) {
      if (std::abs(mode.frequency_hz - frame.frequency_hz(static_cast<std::size_t>(r))) > 0.1) continue;
      worst = std::max(worst, 1.0 - mac(truth, std::span(mode.shape).subspan(1)));
      ++found;
    }
  }
  if (n_found != nullptr) *n_found = found;
  return worst;
}

TEST(CameraLeakage, TakesTheHoverOutOfTheShapes) {
  std::size_t n_found = 0;
  const double without = worst_shape(Filmed{hover(3.0), at_rest}.identified(false));
  const ModalEstimate with_witness = Filmed{hover(3.0), at_rest}.identified(true);
  const double with = worst_shape(with_witness, &n_found);
  EXPECT_EQ(n_found, 3U);
  EXPECT_LT(with, 0.25 * without) << with << " against " << without;
  for (const Mode& mode : with_witness.modes) {
    EXPECT_EQ(mode.shape.size(), 7U);
    EXPECT_EQ(mode.shape_std.size(), 7U);
  }
}

TEST(CameraLeakage, NamesAShakingCamera) {
  // A gimbal that resonates at 3.3 Hz with 2 % damping.
  const double pole = std::exp(-0.02 * 2.0 * 3.14159265 * 3.3 / kRate_hz);
  const auto ringing = [=, random = std::mt19937_64(3), x = 0.0, before = 0.0](int) mutable {
    const double next = 2.0 * pole * std::cos(2.0 * 3.14159265 * 3.3 / kRate_hz) * x - pole * pole * before +
                        0.02 * std::normal_distribution<double>()(random);
    before = x;
    return x = next;
  };
  const ModalEstimate estimate = Filmed{ringing, at_rest}.identified(true);
  std::size_t n_named = 0;
  for (const Mode& mode : estimate.rejected) {
    if (std::abs(mode.frequency_hz - 3.3) > 0.1 || mode.verdict != Verdict::kCameraMotion) continue;
    ++n_named;
    EXPECT_NE(mode.reason.find("a static region moves with it"), std::string::npos) << mode.reason;
  }
  EXPECT_EQ(n_named, 1U);
  for (const Mode& mode : estimate.modes) EXPECT_GT(std::abs(mode.frequency_hz - 3.3), 0.1);
}

TEST(CameraLeakage, LeavesShapesAloneWhereTheWitnessMovesWithTheStructure) {
  const auto with_floor_3 = [](const simulation::StructureResponse& response, double t) {
    return response.displacement_mm(3, t);
  };
  std::size_t n_found = 0;
  const ModalEstimate estimate = Filmed{hover(0.01), with_floor_3}.identified(true);
  EXPECT_LT(worst_shape(estimate, &n_found), 0.01);
  EXPECT_EQ(n_found, 3U);
  std::size_t n_told = 0;
  for (const Mode& mode : estimate.modes) n_told += mode.reason.find("moves with it") != std::string::npos ? 1U : 0U;
  EXPECT_GE(n_told, 1U);
}

TEST(CameraLeakage, WithoutWitnessNothingChanges) {
  const CpsdSums sums = Filmed{hover(1.0), at_rest}.spectra(false);
  const CameraLeakage share(sums, SimulatedStructure{}.channels());
  const std::vector<std::complex<double>> shape{{1.0, 0.1}, 0.9, 0.8, 0.7, 0.6, 0.5, {0.4, -0.2}};
  EXPECT_EQ(share.without(shape, 2.0, false), shape);
  EXPECT_EQ(share.examine(shape, 2.0).share, 0.0);
  EXPECT_FALSE(share.examine(shape, 2.0).is_doubtful);
}

TEST(CpsdSums, CopiesTheTotalsOfItsFirstChannels) {
  CpsdSums all;
  all.n_channels = 3, all.n_fft = 4;
  for (int k = 0; k < 3; ++k) {
    for (int pair = 0; pair < 6; ++pair) all.data_sum.emplace_back(10.0 * k + pair, pair);
  }
  all.mask_sum = all.data_sum;
  CpsdSums first;
  first.copy_totals(all, 2);
  EXPECT_EQ(first.n_channels, 2);
  using Complex = std::complex<double>;
  const std::vector<Complex> expected{{0, 0}, {1, 1}, {3, 3}, {10, 0}, {11, 1}, {13, 3}, {20, 0}, {21, 1}, {23, 3}};
  EXPECT_EQ(first.data_sum, expected);
  EXPECT_EQ(first.mask_sum, expected);
}

}  // namespace
}  // namespace core
