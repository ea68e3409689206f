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

constexpr std::array kEdges_hz{0.0, 0.25, 0.5, 1.0, 2.0};  // a lens is focused slowly
constexpr double kFirstBins = 3.0;                         // of the window's main lobe: what drifts over the record
constexpr double kLeastSeen = 0.05;  // of a breathing, in the zoom of a background hardly behind the structure
constexpr double kApart_s = 1.0;     // of independent values
constexpr double kNoiseFrom_hz = 4.0;
constexpr double kLeastGain = 300.0;
constexpr Index kZoom = 2;             // of the background's motions
constexpr double kNoiseScatter = 1.3;  // of the strongest pattern of noise
constexpr double kOverResidual = 3.0;  // times what the residual's strongest pattern holds in the same band

struct Band {
  Index first = 0, last = 0;  // bins
  double n = 0.0;             // independent values
};

// The background's zoom beyond its causes.
struct Beyond {
  double gain = 0.0;
  double variance = 0.0, sigma = 0.0;  // relative, without noise; of the variance
};

std::vector<Band> bands_of(const TaperedSpectra& spectra) {
  std::vector<Band> out;
  const auto least = static_cast<Index>(std::ceil(kFirstBins / spectra.independent));
  for (std::size_t b = 0; b + 1 < kEdges_hz.size(); ++b) {
    const Index first = std::max(spectra.bin_of(kEdges_hz[b]), least), last = spectra.bin_of(kEdges_hz[b + 1]) - 1;
    if (last > first) out.push_back({first, last, spectra.independent * static_cast<double>(last - first + 1)});
  }
  return out;
}

// Power of the residual's strongest pattern in a band beyond what noise alone gives the strongest of so many
// [Marchenko and Pastur 1967].
double strongest_pattern(const TaperedSpectra& residual, const Band& band) {
  const auto bins = residual.bins.middleCols(band.first, band.last - band.first + 1);
  const Eigen::MatrixXcd moments = bins * bins.adjoint() / static_cast<double>(bins.cols());
  const Eigen::VectorXcd pattern = leading_pattern(moments);
  const double of_noise = std::pow(1.0 + std::sqrt(static_cast<double>(bins.rows()) / (kOfHannWindow * band.n)), 2);
  return std::max(std::real(pattern.dot(moments * pattern)) - kNoiseScatter * of_noise, 0.0);
}

// All products of two of these rows, without their means.
Eigen::MatrixXd products(const Eigen::MatrixXd& rows) {
  const Eigen::MatrixXd centred = rows.colwise() - rows.rowwise().mean();
  Eigen::MatrixXd out(rows.rows() * (rows.rows() + 1) / 2, rows.cols());
  Index at = 0;
  for (Index i = 0; i < rows.rows(); ++i) {
    for (Index k = i; k < rows.rows(); ++k) out.row(at++) = centred.row(i).cwiseProduct(centred.row(k));
  }
  return out;
}

// The focal length changes while the lens is focused. The zoom of one plane is the camera's approach as well; of two
// planes at different depths, an approach zooms each in inverse proportion to its depth, and a change of the focal
// length both alike: the zooms then have two causes. Its centre is the point about which both zoom. Confused with a
// structure that moves towards the camera.
class FocusBreathing final : public AbsorbedEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"focus_breathing"}; }
  [[nodiscard]] std::string name() const override { return "focus breathing"; }
  [[nodiscard]] NotObservable without_background() const override {
    return {name(), "the zoom of a single plane is also the camera's approach",
            "film a background at another depth, or lock the focus"};
  }
  [[nodiscard]] std::optional<AbsorbedFinding> find(const FitView& fit, const FreeMotions& motions) const override {
    const Eigen::MatrixXd causes = causes_of(motions);
    const Eigen::RowVectorXd beyond = beyond_causes(motions.background_zoom, causes);
    const double sigma = motions.background_zoom_sigma;
    const TaperedSpectra zoom = tapered_spectra(beyond / sigma, motions.rate_hz);
    const TaperedSpectra residual = tapered_spectra(fit.model.residual(), motions.rate_hz);
    const Eigen::VectorXd power = zoom.bins.row(0).cwiseAbs2().transpose();
    const double noise = noise_level(zoom, power);
    Beyond of;
    std::vector<NoisyBand> noisy;
    for (const Band& band : bands_of(zoom)) {
      const double mean = power.segment(band.first, band.last - band.first + 1).mean();
      const double level = std::max(noise, kOverResidual * strongest_pattern(residual, band));
      of.gain += power_gain(mean, level, band.n);
      noisy.push_back({band.first, band.last, noise * sigma * sigma});
      const double share = 2.0 * static_cast<double>(band.last - band.first + 1) * zoom.bin_hz / motions.rate_hz;
      of.variance += std::max(mean - noise, 0.0) * share * sigma * sigma;
      of.sigma = std::hypot(of.sigma, mean * share * sigma * sigma / std::sqrt(band.n));
    }
    if (!(of.gain > kLeastGain)) return std::nullopt;
    if (!in_step(fit, kZoom, sigma * zoom.bins.row(0).transpose(), zoom, noisy).is_nothing()) return std::nullopt;
    return finding(motions, beyond, of);
  }

 private:
  [[nodiscard]] static Eigen::MatrixXd causes_of(const FreeMotions& motions) {
    Eigen::MatrixXd linear(3, motions.structure_zoom.size());
    linear << motions.structure_zoom, motions.background;
    const Eigen::MatrixXd squares = products(linear);
    const Eigen::RowVectorXd zoom = motions.structure_zoom.array() - motions.structure_zoom.mean();
    Eigen::MatrixXd causes(3 + squares.rows() + 1 + motions.added.rows(), zoom.size());
    causes << linear, squares, zoom.array().cube().matrix(), motions.added;
    return causes;
  }
  // Of the zoom beyond its causes, in the variance that the points' noise gives it.
  [[nodiscard]] static double noise_level(const TaperedSpectra& zoom, const Eigen::VectorXd& power) {
    const Index from = std::min(zoom.bin_of(kNoiseFrom_hz), power.size() / 2);
    std::vector<double> values(power.data() + from, power.data() + power.size() - 1);
    return std::max(median_in_place(values) / std::numbers::ln2, 1.0);
  }
  // Beyond its causes, the background's zoom is (1 - r) of the breathing (r: the structure's depth over the
  // background's), and its translation beyond r of the structure's is -(1 - r) of the breathing times the centre.
  [[nodiscard]] static AbsorbedFinding finding(const FreeMotions& motions, const Eigen::RowVectorXd& beyond,
                                               const Beyond& of) {
    const Eigen::RowVectorXd structure = motions.structure_zoom.array() - motions.structure_zoom.mean();
    const Eigen::RowVectorXd background = motions.background_zoom.array() - motions.background_zoom.mean();
    const double depths = structure.dot(background - beyond) / structure.squaredNorm();
    const double seen = std::max(std::abs(1.0 - depths), kLeastSeen), rms = std::sqrt(of.variance);
    AbsorbedFinding out;
    out.parameters = {{"rms of the focal length", "%", 100.0 * rms / seen, 50.0 * of.sigma / rms / seen}};
    const auto n = static_cast<double>(beyond.size());
    for (const int axis : {0, 1}) {
      const Eigen::RowVectorXd shift = beyond_causes(motions.background.row(axis), motions.base);
      const double centre = -shift.dot(beyond) / n / of.variance;
      const double left = (shift + centre * beyond).norm() / std::sqrt(n) / rms;
      const double n_independent = std::max(n / (kApart_s * motions.rate_hz), 1.0);
      out.parameters.push_back(
          {axis == 0 ? "centre along u" : "centre along v", "px", centre, left / std::sqrt(n_independent)});
    }
    out.meaning = "the focal length changes as the lens is focused; lock the focus";
    out.score = of.gain, out.threshold = kLeastGain;
    return out;
  }
};

}  // namespace

std::unique_ptr<AbsorbedEffect> make_focus_breathing() { return std::make_unique<FocusBreathing>(); }

}  // namespace core::closure
