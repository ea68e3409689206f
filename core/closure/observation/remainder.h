#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/closure/observation/observation_fit.h"

namespace core::closure {

// A pattern of the residual that an adopted effect leaves of itself, because its form in the model is not exact: small
// beside the effect, at its frequencies, on the points that it moves.
struct Remainder {
  std::string effect;
  double share = 0.0;  // rms of the pattern over that of the effect
};

struct BandHz {
  double low = 0.0, high = 0.0;
};

// Frequencies that hold the squares of a motion (px, 2 points x frames) but its tails, and so much beside them.
[[nodiscard]] BandHz band_of(const Eigen::MatrixXd& motion_px, double rate_hz, double beside_hz);

// Of the named effects in a fit. Both arguments must outlive it.
class Remainders {
 public:
  // residual: moments of the fit's own residual.
  Remainders(const ObservationFit& fit, const ResidualMoments& residual);
  // pattern_px: 2 points long, of any size. Empty: no adopted effect explains it.
  [[nodiscard]] std::optional<Remainder> find(const Eigen::VectorXd& pattern_px, RungSet band) const;

 private:
  struct Adopted {
    std::string name;
    double most_share = 0.0;  // of its rms, in a remainder
    Eigen::VectorXd rms_px;   // of its motion, 2 points long
    BandHz band;
  };
  const FitView view_;
  const ResidualMoments& residual_;
  std::vector<Adopted> adopted_;
};

}  // namespace core::closure
