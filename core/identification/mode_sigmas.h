#pragma once

#include <optional>
#include <vector>

#include "core/identification/camera_leakage.h"
#include "core/identification/folding.h"
#include "core/identification/mode_scatter.h"
#include "core/identification/model_fit.h"
#include "core/identification/neighbour_leakage.h"
#include "core/identification/stabilisation.h"
#include "core/identification/uncertainty.h"
#include "core/types/cpsd.h"
#include "core/types/modal_estimate.h"

namespace core {

struct ModeVariances {
  double frequency_hz = 0.0, damping_ratio = 0.0;  // Hz^2, 1
};
// Under an unknown force no estimate has less: sigma_f / f = sqrt(zeta / (2 pi f T)), sigma_zeta / zeta = 1 / sqrt(2 pi
// zeta f T). {0, 0} for a mode without a frequency.
[[nodiscard]] ModeVariances least_variances(const Mode& mode, double duration_s);

// Robust (from the median absolute deviation). An order has two poles of a mode that is split into two lines
// (join_split_lines()): for the frequency only the one nearest to the line's counts, for the damping both, because the
// second one takes a part of it.
[[nodiscard]] ModeVariances spread_over_orders(const PoleCluster& line, const std::vector<OrderPole>& poles);

// Poles of all orders of one realisation; observed[i], unfolded[i] and leaks[i] belong to the same pole.
struct SigmaInputs {
  const CpsdSums& sums;
  const ModelFit& fit;
  const FoldingConfig& folding;
  const CameraLeakage& camera;
  const std::vector<PoleOfOrder>& observed;
  const std::vector<OrderPole>& unfolded;
  const std::vector<std::optional<NeighbourLeakage>>& leaks;
};

// Standard deviations of all modes but numerical ones, for which they would be meaningless: from the blocks of the
// record (uncertainty.h), raised by the overlap of the segments and by the spread of the line's poles over the model
// orders, and never below the lower bound of any method without a measured input. modes[i] and scatter[i] belong to
// lines[i]; degrees_of_freedom is 0, and no sigma stated, for a record of one block.
struct Sigmas {
  double degrees_of_freedom = 0.0;
  std::vector<std::optional<ModeScatter>> scatter;  // raised by the overlap
};
[[nodiscard]] Sigmas state_sigmas(const SigmaInputs& inputs, const std::vector<PoleCluster>& lines,
                                  std::vector<Mode>& modes);

// Factor of a variance that is estimated from `n_groups` parts of the record as if they were independent: neighbours
// share the overlap of their segments.
[[nodiscard]] double overlap_factor(const CpsdSums& sums, double n_groups);

}  // namespace core
