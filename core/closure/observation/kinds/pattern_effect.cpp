#include "core/closure/observation/kinds/pattern_effect.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

constexpr double kLeastBeside = 1e-3;  // smallest share of a pattern's norm outside the model's columns
constexpr double kFollows = 0.9;       // smallest share of the amplitude's variance explained by motions of the model

double rms(const Eigen::RowVectorXd& a) {
  return a.size() > 0 ? std::sqrt((a.array() - a.mean()).square().mean()) : 0.0;
}

class PatternInModel final : public EffectInModel {
 public:
  PatternInModel(const PatternEffect& effect, bool low_band, const PointGeometry& geometry)
      : EffectInModel(effect.id(), effect.name()),
        effect_(effect),
        low_band_(low_band),
        pattern_(effect.pattern(geometry)) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<PatternInModel>(*this);
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& amplitude) const override {
    ParameterValue size = amplitude_rms(fit, pattern_.cwiseProduct(fit.model.weight()), low_band_, amplitude);
    size.unit = effect_.unit();
    size.value *= effect_.per_unit();
    *size.sigma *= effect_.per_unit();
    const double band_hz = low_band_ ? PointMotionModel::kLowBand_hz : 0.5 * fit.record.rate_hz;
    return {size, {"band", "Hz", band_hz, std::nullopt}};
  }
  [[nodiscard]] const Eigen::VectorXd* pattern() const override { return &pattern_; }
  [[nodiscard]] bool is_low_band() const override { return low_band_; }
  void set_places(const PointGeometry& geometry) override { pattern_ = effect_.pattern(geometry); }
  [[nodiscard]] Eigen::Vector3d rotation() const override { return effect_.rotation(); }

 private:
  const PatternEffect& effect_;
  bool low_band_;
  Eigen::VectorXd pattern_;
};

class PatternCandidate final : public EffectCandidate {
 public:
  PatternCandidate(const PatternEffect& effect, const FitView& fit) : effect_(effect), fit_(fit) {
    const Eigen::VectorXd w = effect.pattern(fit.model.geometry()).cwiseProduct(fit.model.weight());
    const auto beside = [&](const Eigen::MatrixXd& q) -> Eigen::VectorXd {
      Eigen::VectorXd g = w - q * (q.transpose() * w);
      return g.norm() > kLeastBeside * w.norm() ? g.normalized().eval() : Eigen::VectorXd::Zero(w.size()).eval();
    };
    beside_low_ = beside(fit.model.q_low()), beside_high_ = beside(fit.model.q_high());
  }
  [[nodiscard]] double gain(const TestedResidual& residual) const override { return tried(residual).gain; }
  double find(const TestedResidual& residual) override {
    found_ = tried(residual);
    return found_.gain;
  }
  [[nodiscard]] double material_share() const override { return found_.low_band ? kLowBandBar : kFullBandBar; }
  [[nodiscard]] Objection objection() const override {
    if (!follows_motion()) return {};
    return {"its amplitude only follows the motions already in the model", true};
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<PatternInModel>(effect_, found_.low_band, fit_.model.geometry());
  }

 private:
  [[nodiscard]] PatternGain tried(const TestedResidual& residual) const {
    return fit_.held_out.of_pattern(beside_low_, beside_high_, residual.moments, kLowBandBar);
  }
  [[nodiscard]] bool follows_motion() const;

  const PatternEffect& effect_;
  const FitView fit_;
  Eigen::VectorXd beside_low_, beside_high_;
  PatternGain found_;
};

// True if the amplitude only repeats motions of the model. Its cause is then a lens or readout error, not a rotation.
bool PatternCandidate::follows_motion() const {
  const PointMotionModel& model = fit_.model;
  const Eigen::VectorXd w = effect_.pattern(model.geometry()).cwiseProduct(model.weight());
  const Eigen::VectorXd g = w - model.q_low() * (model.q_low().transpose() * w);
  if (!(g.norm() > 0.0)) return false;
  Eigen::RowVectorXd a = g.normalized().transpose() * model.residual();
  // Single regions are excluded: a rotation moves each of them in proportion to its own height.
  const Eigen::Index plane = model.first_plane_row(), rows = std::min<Eigen::Index>(3, model.n_own() - plane);
  Eigen::MatrixXd motions(2 * (rows + (plane > 0 ? 1 : 0)), fit_.record.n_frames());
  // Rates are included: with a readout, a time error appears as the velocity of a motion.
  motions.topRows(rows) = model.amplitudes().middleRows(plane, rows);
  motions.middleRows(rows, rows) = model.rates().middleRows(plane, rows);
  if (plane > 0) {
    motions.row(2 * rows) = model.amplitudes().topRows(plane).colwise().mean();
    motions.row(2 * rows + 1) = model.rates().topRows(plane).colwise().mean();
  }
  if (found_.low_band) {
    motions = (motions * model.cosines()).eval();
    a = (a * model.cosines()).eval();
  }
  const auto noise = static_cast<double>(a.size());
  for (Eigen::Index r = 0; r < motions.rows(); ++r) {
    if (const double norm = motions.row(r).norm(); norm > 0.0) motions.row(r) /= norm;
  }
  Eigen::MatrixXd normal = motions * motions.transpose();
  normal.diagonal().array() += 1e-9;
  const Eigen::VectorXd right = motions * a.transpose();
  const double explained = right.dot(normal.ldlt().solve(right)) - static_cast<double>(motions.rows());
  const double signal = a.squaredNorm() - noise;
  return signal > 0.0 && explained > kFollows * signal;
}

}  // namespace

ParameterValue amplitude_rms(const FitView& fit, const Eigen::VectorXd& w, bool low_band,
                             const Eigen::RowVectorXd& amplitude) {
  const Eigen::MatrixXd& q = low_band ? fit.model.q_low() : fit.model.q_high();
  const auto own = q.leftCols(fit.model.own_rank());
  const Eigen::VectorXd others = w - own * (own.transpose() * w);
  const double share = low_band ? fit.held_out.low_share() : 1.0;
  const double noise = others.norm() > 0.0 ? std::sqrt(share) / others.norm() : 0.0;  // per frame
  const double value = std::sqrt(std::max(std::pow(rms(amplitude), 2) - noise * noise, 0.0));
  const double sigma = noise / std::sqrt(share * static_cast<double>(fit.record.n_frames()));
  return {"rms", "px", value, sigma};
}

std::optional<NotObservable> PatternEffect::obstacle(const FitView& fit, bool is_adopted) const {
  if (is_adopted) return std::nullopt;
  const Eigen::VectorXd w = pattern(fit.model.geometry()).cwiseProduct(fit.model.weight());
  const double left = (w - fit.model.q_high() * (fit.model.q_high().transpose() * w)).norm();
  if (left > kLeastBeside * w.norm()) return std::nullopt;
  return NotObservable{name(), "the free motions of the regions span its pattern",
                       "declare larger regions or a background"};
}

std::unique_ptr<EffectCandidate> PatternEffect::candidate(const FitView& fit) const {
  return std::make_unique<PatternCandidate>(*this, fit);
}

}  // namespace core::closure
