#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/closure/observation/effect.h"
#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/field_drift.h"
#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/random_field.h"

namespace core::closure {
namespace {

constexpr double kLeastPatterns = 6.0;   // fewer: one or some effects with patterns of their own
constexpr double kLeastLikeness = 0.25;  // of a field that drifts

class RefractionInModel final : public EffectInModel {
 public:
  RefractionInModel(EffectId id, std::string name, FieldSize size)
      : EffectInModel(std::move(id), std::move(name)), size_(std::move(size)) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<RefractionInModel>(*this);
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& /*amplitude*/) const override {
    const FieldDrift drift = field_drift(field_px_, fit.model.geometry(), fit.record.rate_hz);
    const double speed = std::hypot(drift.u_px_s, drift.v_px_s);
    return {{"rms per axis", "px", size_.rms_px(), size_.rms_sigma_px},
            {"correlation length", "px", size_.length_px, size_.length_px * size_.length_factor_sigma},
            {"drift along u", "px/s", drift.u_px_s, drift.sigma_px_s},
            {"drift along v", "px/s", drift.v_px_s, drift.sigma_px_s},
            {"correlation time", "s", size_.length_px / speed, size_.length_px / speed * size_.length_factor_sigma}};
  }
  void correct(CorrectionStage stage, const CorrectionView& /*view*/, Eigen::MatrixXd& positions) const override {
    if (stage == CorrectionStage::kTracker && field_px_.size() > 0) positions -= field_px_;
  }
  [[nodiscard]] bool is_refined() const override { return true; }
  void refine(const FitView& fit, const Eigen::RowVectorXd& /*amplitude*/) override {
    Eigen::MatrixXd series = fit.model.residual();
    if (field_px_.size() > 0) series += fit.model.whitened(fit.model.at_common_instants(field_px_));
    const RandomField field(fit);
    const FieldSize size = field.size(residual_moments(fit.model.left_of(series), fit.record.rate_hz));
    if (!(size.gain > 0.0)) return;
    size_ = size;
    freedom_ = field.freedom(size_);
    field_px_ = fit.model.at_own_instants(fit.model.in_px(field.predicted(size_, series)));
  }
  [[nodiscard]] double freedom() const override { return freedom_; }
  [[nodiscard]] bool hides_noise() const override { return true; }

 private:
  FieldSize size_;
  Eigen::MatrixXd field_px_;  // at the points in each frame
  double freedom_ = 0.0;
};

class RefractionCandidate final : public EffectCandidate {
 public:
  RefractionCandidate(EffectId id, std::string name, const FitView& fit)
      : id_(std::move(id)), name_(std::move(name)), fit_(fit), field_(fit) {}
  [[nodiscard]] double gain(const TestedResidual& residual) const override {
    return field_.size(residual.moments).gain;
  }
  double find(const TestedResidual& residual) override {
    size_ = field_.size(residual.moments);
    if (!(size_.gain > 0.0)) return 0.0;
    n_patterns_ = field_.n_patterns(size_, residual.moments);
    return size_.gain;
  }
  [[nodiscard]] double material_share() const override { return kFullBandBar; }
  [[nodiscard]] bool is_learned() const override { return true; }
  [[nodiscard]] bool is_unspecific() const override { return true; }
  [[nodiscard]] Objection objection(const TestedResidual& residual) const override {
    if (n_patterns_ < kLeastPatterns) {
      return {"it has " + std::to_string(std::lround(n_patterns_)) + " patterns: effects with patterns of their own",
              true};
    }
    const Eigen::MatrixXd px = fit_.model.in_px(field_.predicted(size_, residual.values));
    if (field_drift(px, fit_.model.geometry(), fit_.record.rate_hz).likeness < kLeastLikeness)
      return {"it does not drift over the points: errors of the tracker or of a codec", true};
    return {};
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<RefractionInModel>(id_, name_, size_);
  }

 private:
  EffectId id_;
  std::string name_;
  const FitView fit_;
  RandomField field_;
  FieldSize size_;
  double n_patterns_ = 0.0;
};

// Refraction by cells of warm air that drift through the line of sight: a displacement field that is random in space
// and time. Observable by neighbouring points that move alike in many patterns, which pass over the image. Otherwise
// absorbed by every region's own displacement, by what its points have in common; confused with the errors of a codec,
// which do not drift.
class Refraction final : public ObservationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"refraction"}; }
  [[nodiscard]] std::string name() const override { return "refraction of the air"; }
  [[nodiscard]] std::size_t n_parameters() const override { return 5; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& /*fit*/, bool /*is_adopted*/) const override {
    return std::nullopt;
  }
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const override {
    return std::make_unique<RefractionCandidate>(id(), name(), fit);
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_refraction() { return std::make_unique<Refraction>(); }

}  // namespace core::closure
