#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/free_motions.h"
#include "core/closure/observation/in_step.h"
#include "core/linear/median.h"

namespace core::closure {
namespace {

using Eigen::Index;

constexpr std::array kHalfWidths_hz{0.025, 0.05, 0.1, 0.2, 0.4};
constexpr double kSlowest_hz = 0.5;  // below, the camera's own motion hides it
constexpr double kFastest = 0.45;    // of the frame rate
constexpr double kLeastLevel = 0.3;  // of the noise's: where the spectrum has a hole
constexpr double kLeastScore = 300.0;
constexpr double kLeastOwn = 0.15;  // of its power that neither the camera nor the structure explains
constexpr double kMedian = std::numbers::ln2;

// A band of the background's motion along one axis that stands out of its neighbourhood.
struct Peak {
  int axis = 0;
  double gain = 0.0, hz = 0.0, half_hz = 0.0;
  double excess = 0.0;  // of its mean power over its neighbourhood, in noise variances
  double n = 0.0;       // independent values in it
  double own = 0.0;     // share of its power that no other motion explains
  InStep in_step;
  [[nodiscard]] double score() const noexcept { return own * gain; }
};

double median_level(const Eigen::VectorXd& power, Index first, Index last) {
  std::vector<double> values(power.data() + first, power.data() + last + 1);
  return median_in_place(values) / kMedian;
}

Peak highest_peak(const TaperedSpectra& spectra, const Eigen::VectorXd& left, double rate_hz, double noise) {
  Peak best;
  const Eigen::VectorXd all = spectra.bins.row(0).cwiseAbs2().transpose();
  for (const double half_hz : kHalfWidths_hz) {
    const Index half = std::max<Index>(2, spectra.bin_of(half_hz));
    const Index first = std::max(spectra.bin_of(kSlowest_hz), 4 * half + 1);
    const Index last = std::min(spectra.bin_of(kFastest * rate_hz), left.size() - 1 - 4 * half);
    for (Index centre = first; centre <= last; centre += std::max<Index>(1, half / 2)) {
      const double mean = left.segment(centre - half, 2 * half + 1).mean();
      const double below = median_level(left, centre - 4 * half, centre - half - half / 2 - 1);
      const double above = median_level(left, centre + half + half / 2 + 1, centre + 4 * half);
      const double level = std::max(std::sqrt(below * above), kLeastLevel * noise);
      const double n = spectra.independent * static_cast<double>(2 * half + 1);
      const double gain = power_gain(mean, level, n);
      if (!(gain > best.gain)) continue;
      best.gain = gain, best.n = n, best.half_hz = half_hz, best.excess = mean - level;
      const auto inside = left.segment(centre - half, 2 * half + 1);
      const auto places = Eigen::VectorXd::LinSpaced(2 * half + 1, static_cast<double>(centre - half),
                                                     static_cast<double>(centre + half));
      best.hz = spectra.bin_hz * inside.dot(places) / inside.sum();
      best.own = std::min(mean / std::max(all.segment(centre - half, 2 * half + 1).mean(), 1e-300), 1.0);
    }
  }
  return best;
}

// A background that is declared static moves. Its motion is a resonance that neither the camera nor the structure
// shows: a camera moves both, in proportion to their distances, and a ground that shakes moves the structure's base.
// Confused with a second object in the background's region (a branch, a banner), which is the same to the user.
class MovingBackground final : public AbsorbedEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"moving_background"}; }
  [[nodiscard]] std::string name() const override { return "moving background"; }
  [[nodiscard]] NotObservable without_background() const override {
    return {name(), "no region is declared as background", "declare a static region behind the structure"};
  }
  [[nodiscard]] std::optional<AbsorbedFinding> find(const FitView& fit, const FreeMotions& motions) const override {
    Peak best;
    for (const int axis : {0, 1}) {
      const Peak peak = peak_along(fit, motions, axis);
      if (peak.score() > std::max(kLeastScore, best.score()) && peak.own >= kLeastOwn && peak.in_step.is_nothing())
        best = peak;
    }
    if (!(best.gain > 0.0)) return std::nullopt;
    const double duration_s = static_cast<double>(fit.record.n_frames()) / fit.record.rate_hz;
    const double of_rate = 2.0 * best.half_hz / (0.5 * fit.record.rate_hz);  // width of the band
    const double rms = std::sqrt(std::max(best.excess * of_rate, 0.0)) * motions.background_sigma(best.axis);
    AbsorbedFinding out;
    out.parameters = {{"frequency", "Hz", best.hz, std::max(best.half_hz / std::sqrt(best.n), 0.5 / duration_s)},
                      {best.axis == 0 ? "rms along u" : "rms along v", "px", rms, rms / std::sqrt(best.n)},
                      {"of the background's motion in that band", "%", 100.0 * best.own,
                       100.0 * std::max(std::sqrt(best.own * (1.0 - best.own) / best.n), 1.0 / best.n)}};
    out.meaning = "the region declared as background moves by itself; declare another one, or none";
    out.score = best.score(), out.threshold = kLeastScore, out.hz = best.hz;
    return out;
  }

 private:
  [[nodiscard]] static Peak peak_along(const FitView& fit, const FreeMotions& motions, int axis) {
    const Eigen::RowVectorXd zoom = motions.structure_zoom.array() - motions.structure_zoom.mean();
    Eigen::MatrixXd causes(motions.structure.rows() + 3 + motions.added.rows(), zoom.size());
    causes << motions.structure, zoom, motions.base.row(0).cwiseProduct(zoom), motions.base.row(1).cwiseProduct(zoom),
        motions.added;
    Eigen::MatrixXd series(1 + causes.rows(), causes.cols());
    series << beyond_causes(motions.background.row(axis), causes), causes;
    const TaperedSpectra spectra = tapered_spectra(series, motions.rate_hz);
    const Eigen::VectorXcd left = beyond_neighbours(spectra);
    const double noise = motions.background_sigma(axis) * motions.background_sigma(axis);
    Peak peak = highest_peak(spectra, left.cwiseAbs2(), motions.rate_hz, noise);
    if (!(peak.gain > 0.0)) return peak;
    peak.axis = axis, peak.excess /= noise;
    const Index first = spectra.bin_of(peak.hz - peak.half_hz), last = spectra.bin_of(peak.hz + peak.half_hz);
    peak.in_step = in_step(fit, axis, left, spectra, {{first, last, noise}});
    return peak;
  }
};

}  // namespace

std::unique_ptr<AbsorbedEffect> make_moving_background() { return std::make_unique<MovingBackground>(); }

}  // namespace core::closure
