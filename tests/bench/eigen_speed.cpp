// core/linear's eigen-solvers against Eigen's on the matrices of one identification update (12 channels, 300 s at 30
// Hz, three references, orders 2-60), in turns, least of REPEATS in process CPU time:
//   eigen_speed plain|cva BLOCK_ROWS REPEATS SEED
// Symmetric: values of the Gram matrix and its leading 60 vectors. Real: values of every order's A and what the
// channels see of the vectors of the upper half plane. "Eigen, whole": SelfAdjointEigenSolver and EigenSolver, all
// vectors. "Eigen, same algorithm": Eigen's reductions (Tridiagonalization, HessenbergDecomposition) and values without
// vectors (computeFromTridiagonal, RealSchur), then core/linear's inverse iteration.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/identification/block_hankel.h"
#include "core/identification/era.h"
#include "core/identification/hankel_gram.h"
#include "core/identification/hankel_weights.h"
#include "core/identification/stabilisation.h"
#include "core/linear/dense.h"
#include "core/linear/hessenberg_vector.h"
#include "core/linear/real_eigen.h"
#include "core/linear/symmetric_eigen.h"
#include "core/linear/tridiagonal.h"
#include "tests/bench/update_data.h"

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kChannels = 12, kSegment = 1024, kMaxOrder = 60;
const std::vector<int> kReferences{0, 5, 11};

struct Symmetric {
  VectorXd values;   // descending
  MatrixXd vectors;  // of the leading kMaxOrder
};
using Shapes = std::vector<core::UpperEigen>;  // by order

Symmetric symmetric_ours(const MatrixXd& a) {
  const core::SymmetricEigen eigen(a);
  return {eigen.values(), eigen.leading_vectors(kMaxOrder)};
}

Symmetric symmetric_whole(const MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(a);
  return {eigen.eigenvalues().reverse(), eigen.eigenvectors().rowwise().reverse().leftCols(kMaxOrder)};
}

Symmetric symmetric_same(const MatrixXd& a) {
  const Eigen::Tridiagonalization<MatrixXd> reduced(a);
  const VectorXd diagonal = reduced.diagonal(), subdiagonal = reduced.subDiagonal();
  Eigen::SelfAdjointEigenSolver<MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal, subdiagonal, Eigen::EigenvaluesOnly);
  Symmetric out{eigen.eigenvalues().reverse(), {}};
  out.vectors = reduced.matrixQ() * core::tridiagonal_vectors(diagonal, subdiagonal, out.values, kMaxOrder).transpose();
  return out;
}

core::UpperEigen real_ours(const MatrixXd& a, const MatrixXd& c) {
  core::UpperEigen out;
  if (!core::upper_half_plane_eigen(a, c, out)) std::exit(1);
  return out;
}

core::UpperEigen real_whole(const MatrixXd& a, const MatrixXd& c) {
  const Eigen::EigenSolver<MatrixXd> eigen(a);
  const Eigen::MatrixXcd vectors = eigen.eigenvectors();
  core::UpperEigen out;
  std::vector<Index> upper;
  for (Index k = 0; k < a.rows(); ++k)
    if (eigen.eigenvalues()[k].imag() > 0.0) upper.push_back(k), out.values.push_back(eigen.eigenvalues()[k]);
  out.seen = c * vectors(Eigen::all, upper);
  return out;
}

std::vector<Complex> values_of_schur(const MatrixXd& t) {
  std::vector<Complex> out;
  for (Index k = 0; k + 1 < t.rows(); ++k) {
    if (t(k + 1, k) == 0.0) continue;
    const double half = 0.5 * (t(k, k) - t(k + 1, k + 1)), square = half * half + t(k, k + 1) * t(k + 1, k);
    if (square < 0.0) out.emplace_back(t(k + 1, k + 1) + half, std::sqrt(-square));
  }
  return out;
}

core::UpperEigen real_same(const MatrixXd& a, const MatrixXd& c) {
  const Eigen::HessenbergDecomposition<MatrixXd> reduced(a);
  const MatrixXd h = reduced.matrixH(), seen = c * reduced.matrixQ();
  Eigen::RealSchur<MatrixXd> schur;
  schur.computeFromHessenberg(h, MatrixXd::Identity(h.rows(), h.cols()), false);
  core::UpperEigen out;
  out.values = values_of_schur(schur.matrixT());
  out.seen.resize(c.rows(), static_cast<Index>(out.values.size()));
  core::RowMatrix rows{static_cast<int>(h.rows()), std::vector<double>(static_cast<std::size_t>(h.size()))};
  Eigen::Map<RowMajor>(rows.values.data(), h.rows(), h.cols()) = h;
  core::HessenbergVector vector(rows);
  for (std::size_t k = 0; k < out.values.size(); ++k) {
    vector.compute(out.values[k]);
    const auto column = static_cast<Index>(k);
    out.seen.col(column).real() = seen * Eigen::Map<const VectorXd>(vector.re().data(), h.rows());
    out.seen.col(column).imag() = seen * Eigen::Map<const VectorXd>(vector.im().data(), h.rows());
  }
  return out;
}

template <class Solver>
Shapes all_orders(const core::Realisation& realisation, const Solver& solver) {
  Shapes out;
  MatrixXd seen(2 * kChannels, kMaxOrder);
  seen << realisation.c, realisation.c_last;
  for (int order = 2; order <= kMaxOrder; order += 2)
    out.push_back(solver(realisation.a.topLeftCorner(order, order), seen.leftCols(order)));
  return out;
}

// The matrix whose vectors span the realisation (core/identification/realisation_by_gram.cpp).
MatrixXd gram_of(const core::Correlations& correlations, const core::EraConfig& config) {
  const VectorXd scale = core::channel_scale(correlations);
  const Index n_columns = config.block_rows * static_cast<Index>(config.references.size());
  const int p = config.block_rows;
  if (!config.canonical_variates) {
    return core::hankel_gram(correlations, config.references, scale, p, config.first_lag)
        .topLeftCorner(n_columns, n_columns);
  }
  const MatrixXd h0 = core::block_hankel(correlations, config.references, scale, p, p, config.first_lag);
  MatrixXd left, right;
  if (!core::factor_with_ridge(core::future_covariance(correlations, config, scale), h0.transpose(), left) ||
      !core::factor_with_ridge(core::past_covariance(correlations, config, scale),
                               left.bottomRows(n_columns).transpose(), right))
    std::exit(1);
  return core::gram(MatrixXd(right.bottomRows(p * kChannels).transpose()));
}

// One whole update with core/linear, from one hop of samples to clusters.
struct Update {
  core::Correlations correlations;
  core::Realisation realisation;
};

Update update_of(const core::CpsdSums& sums, const core::EraConfig& config) {
  Update out;
  const std::span<const int> pairs_with = config.canonical_variates ? std::span<const int>{} : kReferences;
  if (core::compute_correlations(sums, 2 * config.block_rows + config.first_lag, 0, out.correlations, pairs_with) !=
          core::CorrelationStatus::kOk ||
      core::realise(out.correlations, config, out.realisation) != core::EraStatus::kOk)
    std::exit(1);
  std::vector<core::OrderPole> poles;
  for (int order = 2; order <= kMaxOrder; order += 2) {
    for (const core::DiscretePole& pole : core::poles_of_order(out.realisation, order))
      poles.push_back({order / 2 - 1, core::unfold(pole.lambda, pole.shape, {bench::kRateHz, 0.0, {}})});
  }
  (void)core::cluster_poles(poles, kMaxOrder / 2);
  return out;
}

double furthest(const Shapes& of, const Shapes& from) {
  double worst = 0.0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (of[i].values.size() != from[i].values.size()) return 1.0;
    for (const Complex value : of[i].values) {
      double nearest = 1.0;
      for (const Complex other : from[i].values) nearest = std::min(nearest, std::abs(value - other));
      worst = std::max(worst, nearest);
    }
  }
  return worst;
}

double residual(const MatrixXd& a, const Symmetric& s) {
  return (a * s.vectors - s.vectors * s.values.head(kMaxOrder).asDiagonal()).cwiseAbs().maxCoeff() / s.values[0];
}

double timed(const std::function<void()>& work) {
  const double t0 = bench::cpu_ms();
  work();
  return bench::cpu_ms() - t0;
}

struct Row {
  const char* name;
  double symmetric_ms = 1e300, real_ms = 1e300;
  Symmetric symmetric{};
  Shapes shapes{};
};

int run(const core::EraConfig& config, int repeats, std::uint64_t seed) {
  constexpr std::size_t kHop = kSegment / 2, kBegin = kSegment + 14 * kHop, kN = kChannels;
  const std::vector<double> motion = bench::make_motion(kChannels, 9000, seed);
  core::WelchCpsd start({.n_channels = kChannels, .segment = kSegment, .rate_hz = bench::kRateHz});
  bench::push(start, motion, kN, 0, kBegin);
  Row rows[3] = {{"core/linear"}, {"Eigen, whole"}, {"Eigen, same algorithm"}};
  double whole_ms = 1e300;
  MatrixXd gram;
  for (int k = 0; k < repeats; ++k) {
    core::WelchCpsd welch = start;
    Update update;
    whole_ms = std::min(whole_ms, timed([&] {
                          bench::push(welch, motion, kN, kBegin, kBegin + kHop);
                          update = update_of(welch.sums(), config);
                        }));
    gram = gram_of(update.correlations, config);
    const auto turn = [&](Row& row, const auto& symmetric, const auto& real) {
      row.symmetric_ms = std::min(row.symmetric_ms, timed([&] { row.symmetric = symmetric(gram); }));
      row.real_ms = std::min(row.real_ms, timed([&] { row.shapes = all_orders(update.realisation, real); }));
    };
    turn(rows[0], symmetric_ours, real_ours);
    turn(rows[1], symmetric_whole, real_whole);
    turn(rows[2], symmetric_same, real_same);
  }
  const Row& ours = rows[0];
  std::printf("%s ERA, %d block rows: Gram matrix of %td, 30 orders; update %.2f ms\n",
              config.canonical_variates ? "cva" : "plain", config.block_rows, gram.rows(), whole_ms);
  for (const Row& row : rows) {
    const double update_ms = whole_ms - ours.symmetric_ms - ours.real_ms + row.symmetric_ms + row.real_ms;
    std::printf("%-22s symmetric %8.3f ms  real %8.3f ms  update %.2f times  residual %.1e  values %.1e  poles %.1e\n",
                row.name, row.symmetric_ms, row.real_ms, update_ms / whole_ms, residual(gram, row.symmetric),
                (row.symmetric.values - ours.symmetric.values).cwiseAbs().maxCoeff() / ours.symmetric.values[0],
                furthest(row.shapes, ours.shapes));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() != 4) {
    std::fprintf(stderr, "usage: eigen_speed plain|cva BLOCK_ROWS REPEATS SEED\n");
    return 2;
  }
  core::EraConfig config;
  config.canonical_variates = arguments[0] == "cva";
  config.block_rows = std::stoi(arguments[1]);
  config.max_order = kMaxOrder;
  config.references = kReferences;
  config.with_maps = false;
  return run(config, std::stoi(arguments[2]), std::stoull(arguments[3]));
}
