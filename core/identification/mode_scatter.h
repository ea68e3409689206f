#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/identification/folding.h"
#include "core/identification/uncertainty.h"

namespace core {

// Standard deviations of a mode, from the changes that the parts of a record cause (uncertainty.h).
struct ModeScatter {
  double frequency_hz = 0.0, damping_ratio = 0.0;
  std::vector<double> shape;  // of the components' real parts; the largest component is 1
  std::vector<double> along;  // of the components along their line (phase_line.h); the largest is 1
  // Share of the shape's square that these changes put beside its line, a turn of the whole shape excepted: what a
  // shape in phase would have there by chance.
  double beside_line = 0.0;
};
// Propagates the changes through the logarithm, the alias order and the row delays. Empty with too few blocks, or if
// the result is not finite.
[[nodiscard]] std::optional<ModeScatter> mode_scatter(const PoleOfOrder& pole, const UnfoldedPole& unfolded,
                                                      const FoldingConfig& folding,
                                                      const std::vector<PoleChange>& changes,
                                                      std::size_t n_own = SIZE_MAX);

// The components that a mode states of a pole's observed shape, complex or along the shape's line. Here and above, the
// largest of the first `n_own` components is 1 and the line is theirs; further ones are relative to them.
[[nodiscard]] std::vector<std::complex<double>> stated_components(const PoleOfOrder& pole, const UnfoldedPole& unfolded,
                                                                  const FoldingConfig& folding, bool along,
                                                                  std::size_t n_own);

}  // namespace core
