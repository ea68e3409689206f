#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "core/identification/era.h"
#include "core/identification/folding.h"

namespace core {

// If two poles are closer than their widths in the sampled spectrum, the error of each shape is a multiple of the
// other's shape: half of a weak mode's estimated shape may belong to the strong mode that it folds beside. That part is
// seen with the row delays of another frequency, so the delays determine it. The corrected shape is
//     phi - c psi        phi: shape of the pole, psi: of its neighbour, both as observed; c: one complex number.
// c is chosen so that the components are in phase once the delays are undone for the pole's own alias order (least
// squares about the best common phase).
class NeighbourLeakage {
 public:
  // Empty if less than a fifth of the shape's square would remain, or nothing can be fitted. s: signed frequency of the
  // hypothesis, rad/s (Im < 0: the other member of the conjugate pair).
  [[nodiscard]] static std::optional<NeighbourLeakage> fit(const std::vector<std::complex<double>>& shape,
                                                           const std::vector<std::complex<double>>& neighbour,
                                                           std::complex<double> s, const FoldingConfig& config);

  // phi - c psi, of the shape fitted or of a change of it; linear over the real numbers.
  [[nodiscard]] std::vector<std::complex<double>> without(const std::vector<std::complex<double>>& shape) const;

 private:
  NeighbourLeakage(std::vector<std::complex<double>> neighbour, std::complex<double> s, const FoldingConfig& config);
  [[nodiscard]] std::complex<double> coefficient(const std::vector<std::complex<double>>& shape) const;
  [[nodiscard]] double out_of_phase(const std::vector<std::complex<double>>& shape) const;

  std::vector<std::complex<double>> neighbour_;  // as observed
  std::vector<std::complex<double>> turn_;       // per channel: undoes the delay and the common phase
};

// Unfolds the poles of one order, each as folding.h does and, beside a neighbour with another alias order, without what
// leaks from it: where that explains the shape better than any alias order alone, at an MPC reduced by the two
// parameters fitted, leaks[i] is set. Of two that mix, the better defined one frees the other, and then that one it.
struct UnfoldedOrder {
  std::vector<UnfoldedPole> poles;
  std::vector<std::optional<NeighbourLeakage>> leaks;
};
// shape: per pole, as observed, without the camera's part.
[[nodiscard]] UnfoldedOrder unfold_order(const std::vector<DiscretePole>& poles,
                                         const std::vector<std::vector<std::complex<double>>>& shape,
                                         const FoldingConfig& config);

}  // namespace core
