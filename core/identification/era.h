#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/identification/correlation.h"

namespace core {

enum class EraStatus : std::uint8_t { kOk, kTooFewLags, kRankDeficient };

struct EraConfig {
  int block_rows = 30;  // block rows and columns
  int first_lag = 1;    // earlier lags contain the sensor noise: 1 + number of differences
  int max_order = 60;
  int above_canonical = 0;      // > 0: largest order is canonical_order() plus this
  std::vector<int> references;  // channel indices
  // Measured inputs, channel indices, none of them a reference: what they explain is taken out of the Hankel matrix
  // (given_inputs.h). With canonical variates only.
  std::vector<int> inputs;
  // Canonical-variate weighting of the Hankel matrix, G = Lf^-1 H Lp^-T with the Cholesky factors of future and past
  // covariance: variances are near the bound, weak modes are found, and the singular values are canonical correlations
  // (METHOD.md). false: the plain ERA of Juang & Pappa 1985.
  bool canonical_variates = true;
  bool with_maps = true;  // fill left_map and right_map
};

// One factorisation for all orders: the realisation of order n is the leading n x n part.
struct Realisation {
  Eigen::VectorXd singular_values;  // canonical correlations, 0..1, when weighted
  Eigen::MatrixXd a;                // max_order x max_order, in balanced coordinates
  Eigen::MatrixXd c;                // n_channels x max_order, channel units: first block row of the observability
  Eigen::MatrixXd c_last;           // n_steps block rows later: its last block row
  int n_steps = 0;
  // a = left_map H1 right_map with the Hankel matrix H1 of unit-variance channels (shifted by one lag); the same
  // product with the unshifted H0 is the identity. Each pole is a generalised eigenvalue of two matrices linear in R.
  Eigen::MatrixXd left_map;   // max_order x (block rows * channels), without inputs
  Eigen::MatrixXd right_map;  // (block columns * (references and inputs)) x max_order
  Eigen::VectorXd scale;      // standard deviation per channel
  // With inputs: their part in the outputs' future and in the past (given_inputs.h); rows of their channels in c are 0.
  Eigen::MatrixXd by_input, of_past;
};

// A pole of the discrete system and its shape in channel units.
struct DiscretePole {
  std::complex<double> lambda;
  std::vector<std::complex<double>> shape;
  double emac = 0.0;  // extended modal amplitude coherence of the outputs, 0..1 (modal_coherence.h)
};

[[nodiscard]] EraStatus realise(const Correlations& correlations, const EraConfig& config, Realisation& out);

// Poles in the upper half plane of the realisation of this order.
[[nodiscard]] std::vector<DiscretePole> poles_of_order(const Realisation& realisation, int order);

// The order at which canonical correlations fall below one half, rounded up to even.
[[nodiscard]] int canonical_order(const Realisation& realisation, double threshold = 0.5);
[[nodiscard]] int canonical_order(const Eigen::Ref<const Eigen::VectorXd>& singular_values, double threshold = 0.5);

}  // namespace core
