#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "core/identification/block_deviations.h"
#include "core/identification/era.h"
#include "core/types/modal_estimate.h"

namespace core {

// Standard deviations by the delta method, without a second fit. With the weights and the subspace of a realisation
// held fixed, a pole is a generalised eigenvalue of two matrices linear in the correlations R,
//   left_map (dH1 - lambda dH0) right_map,
// and its first-order change is therefore linear in R, as is that of its shape H0 right_map psi. Blocks of the record
// (CpsdBlock) give independent changes of R that sum to zero: var = K / (K - 1) sum of the squared changes, with K - 1
// degrees of freedom (Student): two blocks give a variance, with one degree of freedom. More than ten blocks would be
// too short, because a block should span a few decay times of the slowest mode.
inline constexpr std::size_t kLeastScatterBlocks = 2, kScatterBlocks = 10;

// Change of a pole, of its observed shape and of its vector (pole_vector()) caused by one block.
struct PoleChange {
  std::complex<double> lambda;
  std::vector<std::complex<double>> shape;
  Eigen::VectorXcd psi = {};
};

struct PoleOfOrder {
  int order = 0;
  DiscretePole pole;  // from poles_of_order()
};

// Indexed [pole][block]. `deviations`: of the references and lags of hankel_changes.h. Empty for a pole that is not
// found again.
[[nodiscard]] std::vector<std::vector<PoleChange>> pole_changes(const Realisation& realisation, const EraConfig& config,
                                                                const BlockDeviations& deviations,
                                                                const std::vector<PoleOfOrder>& poles);

// Eigenvector of a pole in the realisation's coordinates; its shape is factor * c psi. Empty for a pole that is not
// found again.
struct PoleVector {
  Eigen::VectorXcd psi;
  std::complex<double> factor;
};
[[nodiscard]] PoleVector pole_vector(const Realisation& realisation, const PoleOfOrder& pole);

// Half width of the two-sided 95 % interval in standard deviations (Student's t; between integer degrees of freedom,
// linear in their reciprocal).
[[nodiscard]] double student_95(double degrees_of_freedom) noexcept;

// Interval of a damping ratio, symmetric in its logarithm: its sigma grows with its value, so a low estimate has a
// standard deviation that is too small. (In 600 simulated records with 30 cycles of memory, 93.0 % contained the truth,
// against 91.2 % of plain intervals.)
struct Interval {
  double low = 0.0, high = 0.0;
};
[[nodiscard]] std::optional<Interval> damping_interval_95(const Mode& mode, double degrees_of_freedom) noexcept;

}  // namespace core
