#pragma once

#include "core/closure/observation/effect.h"

namespace core::closure {

// Camera rotation in a band of frequencies, found by line_search.h.
class LineEffect : public ObservationEffect {
 public:
  // Patterns over the image, px per rad, 2 points x 3.
  [[nodiscard]] virtual Eigen::MatrixXd patterns(const PointGeometry& geometry, double readout_frames) const = 0;

  // True: line of a steady rotor; false: a band. One search finds both; the width of the finding decides.
  [[nodiscard]] virtual bool is_steady() const = 0;

  [[nodiscard]] std::size_t n_parameters() const final { return 1; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const final;
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const final;
};

}  // namespace core::closure
