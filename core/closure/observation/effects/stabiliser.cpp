#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/free_motions.h"
#include "core/closure/observation/in_step.h"
#include "core/closure/observation/row_spectra.h"
#include "core/closure/observation/shift_response.h"
#include "core/spectrum/real_fft.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

using Eigen::Index;

constexpr double kLeastScore = 150.0;
constexpr double kLeastSigmas = 3.0;
constexpr double kOfFree = 0.8;       // of what the best response of any form explains
constexpr double kLeastApart = 0.05;  // of the ratio of the depths and the response: the background moves by less

// Change of the frames' shift per frame, 2 x frames in px, from the background's motion (r - G) c, c: of the camera.
Eigen::MatrixXd shift_rates(const FreeMotions& motions, const FittedShift& fitted) {
  RealFft fft(row_fft_size(motions.background));
  std::vector<double> series(static_cast<std::size_t>(fft.size()));
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(fft.n_bins()));
  Eigen::MatrixXd out(2, motions.background.cols());
  const double bin_hz = motions.rate_hz / fft.size();
  for (Index axis = 0; axis < 2; ++axis) {
    const Eigen::RowVectorXd background = motions.background.row(axis).array() - motions.background.row(axis).mean();
    std::fill(series.begin(), series.end(), 0.0);
    std::copy(background.begin(), background.end(), series.begin());
    fft.forward(series, bins);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      const double hz = bin_hz * static_cast<double>(b);
      const std::complex<double> of_camera = fitted.response.gain * fitted.response.form(hz),
                                 rest = fitted.depths - of_camera;
      bins[b] *= std::abs(rest) > kLeastApart
                     ? std::complex<double>(0.0, kTwoPi * hz / motions.rate_hz) * of_camera / rest
                     : 0.0;
    }
    fft.inverse(bins, series);
    out.row(axis) = Eigen::Map<const Eigen::RowVectorXd>(series.data(), out.cols());
  }
  return out;
}

// A frame is shifted as a whole, at the middle of its readout; the model lets each row move at its own time.
Eigen::MatrixXd left_by_rows(const FitView& fit, const FreeMotions& motions, const FittedShift& fitted) {
  const Eigen::MatrixXd rates = shift_rates(motions, fitted);
  const Eigen::VectorXd& share = fit.model.geometry().share;
  Eigen::MatrixXd shifted(2 * share.size(), rates.cols());
  for (Index j = 0; j < share.size(); ++j)
    shifted.middleRows(2 * j, 2) = fit.readout_frames * (share(j) - PointMotionModel::kCommonShare) * rates;
  return fit.model.left_at_common_instants(std::move(shifted));
}

// An electronic stabiliser shifts each frame as a whole against the camera's motion above a corner frequency, with a
// gain and a lag: of two planes at different depths, one then moves like the other times a response
// (shift_response.h). Only the direction in which the base does not move by itself is used. Confused with turns of the
// camera that follow its translation; those leave a field of their own in the residual.
class Stabiliser final : public AbsorbedEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"stabiliser"}; }
  [[nodiscard]] std::string name() const override { return "stabiliser"; }
  [[nodiscard]] NotObservable without_background() const override {
    return {name(), "it shifts a single plane as the camera's own motion does",
            "film a background at another depth, or switch the camera's stabilisation off"};
  }
  [[nodiscard]] std::optional<AbsorbedFinding> find(const FitView& fit, const FreeMotions& motions) const override {
    if (motions.still.isZero()) return std::nullopt;
    const Eigen::RowVectorXd zoom = motions.structure_zoom.array() - motions.structure_zoom.mean();
    Eigen::MatrixXd series(8 + motions.added.rows(), zoom.size());
    const Eigen::MatrixXd background = motions.background.colwise() - motions.background.rowwise().mean(),
                          base = motions.base.colwise() - motions.base.rowwise().mean();
    const Eigen::RowVectorXd still = motions.still.transpose() * base;
    series << motions.still.transpose() * background, still, zoom, zoom.cwiseProduct(zoom),
        base.row(0).cwiseProduct(zoom), base.row(1).cwiseProduct(zoom), still.cwiseProduct(base.row(0)),
        still.cwiseProduct(base.row(1)), motions.added;
    const TaperedSpectra spectra = tapered_spectra(series, motions.rate_hz);
    const ShiftRegression regression(spectra);
    const FittedShift found = regression.fit();
    if (!(found.rise > std::max(kLeastScore, kOfFree * found.free_rise))) return std::nullopt;
    if (!(found.response.gain > kLeastSigmas * found.gain_sigma)) return std::nullopt;
    const Index axis = std::abs(motions.still.y()) > std::abs(motions.still.x()) ? 1 : 0;
    std::vector<NoisyBand> bands;
    for (const ShiftRegression::Band& band : regression.bands()) bands.push_back({band.first, band.last, 0.0});
    if (!in_step(fit, axis, found.shift, spectra, bands).is_nothing()) return std::nullopt;
    AbsorbedFinding out;
    out.parameters = {{"gain", "%", 100.0 * found.response.gain, 100.0 * found.gain_sigma},
                      {"corner frequency", "Hz", found.response.corner_hz, found.corner_sigma},
                      {"lag", "s", found.response.lag_s, found.lag_sigma}};
    out.meaning = "the camera shifts its frames against its own motion; switch its stabilisation off";
    out.score = found.rise, out.threshold = kLeastScore;
    out.left = left_by_rows(fit, motions, found);
    return out;
  }
};

}  // namespace

std::unique_ptr<AbsorbedEffect> make_stabiliser() { return std::make_unique<Stabiliser>(); }

}  // namespace core::closure
