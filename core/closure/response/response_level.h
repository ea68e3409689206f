#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/closure/response/response_model.h"

namespace core::closure {

// Response level: a ResponseModel (clock readings, free decays, loggers, series of channels) in the common loop. Score
// = decrease of the held-out squares in units of the noise variance. Rival: its held-out squares exceed those of the
// adopted model by at most three standard errors of their difference over the left-out parts, and its held-out rms by
// at most a quarter. If no parameter of an effect differs from zero by kFromZero of its standard deviations (over
// left-out parts of the record), it is not adopted but reported as indistinguishable from zero.
class ResponseLevel final : public ClosureLevel {
 public:
  static constexpr double kRivalErrors = 3.0;
  static constexpr double kRivalRms = 1.25;
  static constexpr double kFromZero = 3.0;  // standard deviations that an effect's own size must lie from zero

  // The model must outlive the level.
  explicit ResponseLevel(const ResponseModel& model) : model_(model) {}

  [[nodiscard]] std::string name() const override { return "response"; }
  [[nodiscard]] std::string unit() const override { return model_.unit(); }
  [[nodiscard]] std::vector<NotObservable> not_observable() const override { return model_.not_observable(); }
  [[nodiscard]] std::vector<std::string> candidates() const override;
  LevelFit fit() override;
  [[nodiscard]] std::vector<CandidateScore> score() override;
  [[nodiscard]] double surrogate_score(std::uint64_t seed) override;
  void adopt(std::size_t candidate) override { adopted_.push_back(candidates().at(candidate)); }
  void drop() override { adopted_.pop_back(); }
  [[nodiscard]] std::vector<ParameterValue> parameters(std::size_t adopted) const override;
  [[nodiscard]] std::vector<std::string> rivals(std::size_t adopted, std::uint64_t seed) override;
  [[nodiscard]] std::vector<ClosureMode> modes() const override { return fit_.modes; }
  [[nodiscard]] std::optional<double> reference_error() const override { return fit_.heldout_rms; }
  [[nodiscard]] std::string describe_residual() const override { return fit_.left; }

  [[nodiscard]] const std::vector<std::string>& adopted() const noexcept { return adopted_; }

 private:
  [[nodiscard]] std::vector<std::string> with(const std::string& effect) const;
  [[nodiscard]] std::string refusal(const std::string& effect, const ResponseFit& fit) const;

  const ResponseModel& model_;
  std::vector<std::string> adopted_;
  ResponseFit fit_;
};

}  // namespace core::closure
