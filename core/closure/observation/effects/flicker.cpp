#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/gaussian_mean.h"
#include "core/closure/observation/held_out.h"
#include "core/closure/observation/kinds/course_effect.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

constexpr std::array kLamps_hz{100.0, 120.0};  // twice the frequency of the mains
constexpr double kOff_hz = 0.5;                // of the lamps or of the camera's clock, together
constexpr double kLeastCycles = 4.0;           // of the beat in the record: slower is drift
constexpr double kWander_hz = 0.15;            // of the mains within a record, to either side
constexpr double kOfBeat = 0.5;                // ... but at most this share of the beat
constexpr double kMostFluctuation = 0.3;       // of the amplitude: lamps are steady
constexpr double kSlow_s = 0.7;                // sigma of a mean over time that holds what is slower than the wander
constexpr double kHighest = 0.49;              // of the frame rate: both phases must be seen

struct Lamps {
  double hz = 0.0;
  double side = 1.0;  // of a multiple of the frame rate: sense in which the beat turns
};

// Lamps whose beat with the frames has this apparent frequency.
std::optional<Lamps> lamps(double apparent_hz, double rate_hz) {
  for (const double nominal_hz : kLamps_hz) {
    for (const double side : {1.0, -1.0}) {
      const double hz = std::round((nominal_hz - side * apparent_hz) / rate_hz) * rate_hz + side * apparent_hz;
      if (std::abs(hz - nominal_hz) <= kOff_hz) return Lamps{hz, side};
    }
  }
  return std::nullopt;
}

// Mean over the points of each region of how much later than on average they are read: regions x frames, in frames;
// less what of the mean of all regions changes slowly, which the motion in the beat's band holds already.
Eigen::MatrixXd later_of_regions(const FitView& fit) {
  const Eigen::MatrixXd later = fit.readout_frames * later_in_readout(fit.record, fit.predicted_px);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(fit.record.regions.size()), later.cols());
  Eigen::VectorXd n = Eigen::VectorXd::Zero(out.rows());
  for (Eigen::Index j = 0; j < later.rows(); ++j) {
    const auto region = static_cast<Eigen::Index>(fit.record.region_of_point[static_cast<std::size_t>(j)]);
    out.row(region) += later.row(j);
    n(region) += 1.0;
  }
  const Eigen::RowVectorXd mean = out.colwise().sum() / n.sum(),
                           slow = gaussian_mean(mean, kSlow_s * fit.record.rate_hz);
  for (Eigen::Index r = 0; r < out.rows(); ++r) out.row(r) = (n(r) > 0.0 ? (out.row(r) / n(r)).eval() : mean) - slow;
  return out;
}

Eigen::MatrixXd course_of(const Eigen::VectorXcd& turning) {
  Eigen::MatrixXd out(2, turning.size());
  out.row(0) = turning.real().transpose(), out.row(1) = turning.imag().transpose();
  out.colwise() -= out.rowwise().mean().eval();
  return out;
}

// The strongest motion in a band of the points' spectra, as an analytic series over the frames.
class BandMotion {
 public:
  BandMotion(const Eigen::MatrixXcd& spectrum, Eigen::Index first, Eigen::Index last) : first_(first) {
    const Eigen::MatrixXcd band = spectrum.middleCols(first, last - first + 1);
    bins_ = leading_pattern(Eigen::MatrixXcd(band.adjoint() * band)).conjugate();  // bins x bins: fewer than rows
  }
  // n_fft: of the spectrum.
  [[nodiscard]] Eigen::VectorXcd series(Eigen::Index n_frames, double n_fft) const {
    Eigen::VectorXcd out = Eigen::VectorXcd::Zero(n_frames);
    for (Eigen::Index b = 0; b < bins_.size(); ++b) {
      const std::complex<double> turn = std::polar(1.0, kTwoPi * static_cast<double>(first_ + b) / n_fft);
      std::complex<double> now = bins_(b);
      for (Eigen::Index k = 0; k < n_frames; ++k, now *= turn) out(k) += now;
    }
    return out;
  }

 private:
  Eigen::Index first_;
  Eigen::VectorXcd bins_;
};

// Standard deviation of the modulus over its mean: 0.52 for a random vibration in a narrow band.
double fluctuation(const Eigen::VectorXcd& series) {
  const Eigen::ArrayXd modulus = series.array().abs();
  const double mean = modulus.mean();
  return mean > 0.0 ? std::sqrt((modulus - mean).square().mean()) / mean : 1.0;
}

// Tracking error by lamps that flicker with the mains, seen as their beat with the frame rate: in every point of its
// own size, direction and phase (the rows are exposed one after another, and points drift over the rows), with a
// frequency that wanders as that of the mains and an amplitude that does not. Observable where the beat is neither
// slower than the record nor at half the frame rate; confused with a steady force on the structure at the same
// frequency.
class Flicker final : public CourseEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"flicker"}; }
  [[nodiscard]] std::string name() const override { return "flicker"; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool is_adopted) const override {
    const double least = least_hz(fit), rate = fit.record.rate_hz;
    for (const double nominal_hz : kLamps_hz) {
      if (std::abs(nominal_hz - std::round(nominal_hz / rate) * rate) + kOff_hz > least || is_adopted)
        return std::nullopt;
    }
    return NotObservable{"flicker of lamps", "their beat with the frame rate is slower than the record shows",
                         "film at another frame rate, or for longer"};
  }
  [[nodiscard]] bool wanders() const override { return true; }
  [[nodiscard]] std::optional<PointCourses> courses(const FitView& fit, const TestedResidual& residual) const override {
    const double rate = fit.record.rate_hz;
    const Eigen::MatrixXcd& spectrum = residual.moments.spectrum;
    const double n_fft = 2.0 * static_cast<double>(spectrum.cols() - 1);
    const std::optional<Eigen::Index> at = strongest_beat(fit, spectrum);
    if (!at) return std::nullopt;
    const double hz = static_cast<double>(*at) * rate / n_fft;
    const auto width =
        std::max<Eigen::Index>(2, static_cast<Eigen::Index>(std::min(kWander_hz, kOfBeat * hz) * n_fft / rate));
    const BandMotion beat(spectrum, std::max<Eigen::Index>(1, *at - width), std::min(spectrum.cols() - 2, *at + width));
    const Eigen::VectorXcd series = beat.series(residual.values.cols(), n_fft);
    if (!(fluctuation(series) < kMostFluctuation)) return std::nullopt;
    const Eigen::VectorXcd turning = series.array() / series.array().abs();
    const Eigen::Index n = turning.size();
    const double turn = std::arg(turning.head(n - 1).dot(turning.tail(n - 1)));
    PointCourses out{{}, fit.record.region_of_point, turn / kTwoPi * rate};
    const Lamps seen = lamps(hz, rate).value_or(Lamps{});
    const Eigen::MatrixXd later = later_of_regions(fit);
    for (Eigen::Index r = 0; r < later.rows(); ++r) {
      const Eigen::ArrayXd phase = seen.side * kTwoPi * seen.hz / rate * later.row(r).transpose().array();
      out.sets.push_back(course_of(turning.array() * (phase.cos() + std::complex<double>(0.0, 1.0) * phase.sin())));
    }
    return out;
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit, const Eigen::MatrixXd& motion_px,
                                                       const PointCourses& courses) const override {
    const double amplitude = std::sqrt(2.0 * motion_px.squaredNorm() / static_cast<double>(motion_px.size()));
    return {{"frequency of the lamps", "Hz", lamps(courses.hz, fit.record.rate_hz).value_or(Lamps{}).hz, std::nullopt},
            {"apparent frequency", "Hz", courses.hz, std::nullopt},
            {"amplitude, rms of the points", "px", amplitude,
             fit.sigma_px * std::sqrt(2.0) / std::sqrt(static_cast<double>(motion_px.size()))}};
  }

 private:
  [[nodiscard]] static double least_hz(const FitView& fit) {
    return kLeastCycles * fit.record.rate_hz / static_cast<double>(fit.record.n_frames());
  }
  // Bin where the sum of the points' powers is largest, among those at which lamps may beat.
  [[nodiscard]] static std::optional<Eigen::Index> strongest_beat(const FitView& fit,
                                                                  const Eigen::MatrixXcd& spectrum) {
    const double rate = fit.record.rate_hz, hz_per_bin = 0.5 * rate / static_cast<double>(spectrum.cols() - 1);
    const auto first = static_cast<Eigen::Index>(std::ceil(least_hz(fit) / hz_per_bin));
    const auto last = std::min(static_cast<Eigen::Index>(kHighest * rate / hz_per_bin), spectrum.cols() - 2);
    std::optional<Eigen::Index> at;
    double most = 0.0;
    for (Eigen::Index bin = std::max<Eigen::Index>(first, 1); bin <= last; ++bin) {
      if (!lamps(static_cast<double>(bin) * hz_per_bin, rate)) continue;
      if (const double power = spectrum.col(bin).squaredNorm(); power > most) most = power, at = bin;
    }
    return at;
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_flicker() { return std::make_unique<Flicker>(); }

}  // namespace core::closure
