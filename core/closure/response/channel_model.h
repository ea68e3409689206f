#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/closure/response/channel_course.h"
#include "core/closure/response/channel_predictor.h"
#include "core/closure/response/effects/channel_effect.h"
#include "core/closure/response/response_model.h"

namespace core::closure {

enum class InputUse : std::uint8_t {
  kKnown,    // the measured base is part of the model from the start
  kUnknown,  // the model assumes white input; the measured base is an effect that may be adopted
};

// Series of channels, modelled as a linear structure under white forces: the predictor of channel_predictor.h. Squares
// are those of the whitened innovations; a sample removed by an effect counts as noise. Held out: ten contiguous parts.
// Unit: standard deviation of the innovations.
class ChannelModel final : public ResponseModel {
 public:
  static constexpr Eigen::Index kOrder = 6;
  static constexpr double kInputMaterial = 0.05;  // of the held-out squares

  // Throws std::invalid_argument: no rate, fewer than two channels, none that moves, fewer than 60 samples per
  // regressor.
  explicit ChannelModel(ChannelRecord record, InputUse use = InputUse::kKnown);

  [[nodiscard]] std::string unit() const override { return "innovation sd"; }
  [[nodiscard]] std::vector<std::string> effects() const override;
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] double material_share(const std::string& effect) const override;
  [[nodiscard]] ResponseFit fit(const std::vector<std::string>& effects) const override;
  [[nodiscard]] std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>& effects,
                                                         std::uint64_t seed) const override;

  // The record as corrected by the effects: with gaps for lost samples, without repeated ones, and on a time axis along
  // which frequencies are constant (at the mean of a drift, at zero amplitude of a softening).
  [[nodiscard]] ChannelRecord corrected(const std::vector<std::string>& effects) const;
  // Description of these corrections, one entry per effect.
  [[nodiscard]] std::vector<std::string> repairs(const std::vector<std::string>& effects) const;

 private:
  // The record after the effects that change its samples, and its predictor: shared by sets of effects.
  struct Prepared {
    ChannelRecord record, relative, scaled;
    ChannelPredictor predictor;
    std::vector<ChannelEffect::Corrected> done;           // per correcting effect, in the key's order; record omitted
    Eigen::MatrixXd derivative;                           // result of frequency_derivative()
    double log_det = 0.0;                                 // of the whitener
    mutable std::map<std::string, CourseFit> course_fit;  // by effect; cached, because the fit is slow
  };
  using Key = std::vector<std::string>;
  [[nodiscard]] Key key_of(const std::vector<std::string>& effects) const;
  [[nodiscard]] const Prepared& prepared(const Key& key) const;
  [[nodiscard]] double predictable_share_of_input() const;

  [[nodiscard]] static const CourseFit& fitted_course(const Prepared& prepared, const std::string& effect,
                                                      const Eigen::VectorXd& course);

  // Innovations after removal of a frequency course; each part uses the coefficient fitted to the others.
  [[nodiscard]] static Eigen::MatrixXd without_course(const Prepared& prepared, const Eigen::VectorXd& course,
                                                      const Eigen::MatrixXd& innovation);

  ChannelRecord record_;
  InputUse use_;
  bool made_up_ = false;  // surrogate: only its score is needed
  mutable std::map<Key, std::unique_ptr<Prepared>> prepared_;
};

}  // namespace core::closure
