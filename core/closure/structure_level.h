#pragma once

#include <optional>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/structure/first_order.h"
#include "core/structure/frame_fit.h"

namespace core::closure {

// Structure level: frequencies (and shapes, where given) of a declared shear frame are compared with reference modes.
// Unit: percent of frequency; a shape's error counts as one of its frequency of as many sigmas. Cross-validation: one
// mode at a time is held out and predicted from the others. Score = decrease of the summed squared prediction errors,
// in units of the reference's variances.
class StructureLevel final : public ClosureLevel {
 public:
  // Materiality threshold: an effect must at least halve the leave-one-out error, or leave no more than the stated
  // noise.
  static constexpr double kMaterial = 0.5;

  // Throws std::invalid_argument (core/structure/declared_frame.h). `check`: modes excluded from every fit. If it is
  // given, reference_error() is computed on these modes, otherwise it is the leave-one-out error. `unpaired`: measured
  // modes that are none of the declared model's (pair_with_model): an effect may make them its own.
  StructureLevel(structure::DeclaredFrame declared, std::vector<structure::ReferenceMode> reference,
                 std::vector<structure::ReferenceMode> check = {}, std::vector<structure::ReferenceMode> unpaired = {});

  [[nodiscard]] std::string name() const override { return "structure"; }
  [[nodiscard]] std::string unit() const override { return "%"; }
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] std::vector<std::string> candidates() const override;
  LevelFit fit() override;
  [[nodiscard]] std::vector<CandidateScore> score() override;
  [[nodiscard]] double surrogate_score(std::uint64_t seed) override;
  void adopt(std::size_t candidate) override;
  void drop() override;
  // One without which the others explain the reference no worse than chance, and plausibly.
  std::optional<std::size_t> drop_needless() override;
  [[nodiscard]] std::vector<ParameterValue> parameters(std::size_t adopted) const override;
  [[nodiscard]] std::string meaning(std::size_t adopted) const override;
  [[nodiscard]] std::vector<std::string> rivals(std::size_t adopted, std::uint64_t seed) override;
  [[nodiscard]] std::vector<ClosureMode> modes() const override;
  [[nodiscard]] std::optional<double> reference_error() const override;
  [[nodiscard]] std::string describe_residual() const override;

  // After the last fit(): the model with its effects, its fit, and the standard deviation of the residual in sigmas, at
  // least 1.
  [[nodiscard]] const structure::FrameModel& model() const noexcept { return model_; }
  [[nodiscard]] const structure::FrameFit& fitted() const noexcept { return fit_; }
  [[nodiscard]] double spread() const;
  // All of the model's modes after the last fit().
  [[nodiscard]] structure::FrameModes model_modes() const;
  [[nodiscard]] const std::vector<structure::ReferenceMode>& check() const noexcept { return check_; }
  // The measured modes that take part, under their numbers in model(); and those that are none of its modes.
  [[nodiscard]] const std::vector<structure::ReferenceMode>& reference() const noexcept { return reference_; }
  [[nodiscard]] std::vector<structure::ReferenceMode> unpaired() const;

 private:
  using Effect = const structure::StructuralEffect*;
  using Reference = std::vector<structure::ReferenceMode>;

  [[nodiscard]] std::vector<Effect> open() const;  // observable and not adopted
  [[nodiscard]] structure::FrameModel with(Effect effect) const;
  [[nodiscard]] std::string refusal(const structure::FrameModel& model, const structure::FrameFit& fit,
                                    const structure::LeaveOneOut& loo) const;
  [[nodiscard]] std::string implausible(const structure::FrameModel& model, const structure::FrameFit& fit) const;
  [[nodiscard]] static Reference surrogate(const structure::FrameModel& model, const structure::FrameFit& fit,
                                           Reference reference, double spread, std::uint64_t seed);
  [[nodiscard]] bool is_like_an_effect() const;
  [[nodiscard]] double fitted_surrogate_score(std::uint64_t seed) const;
  [[nodiscard]] bool is_rival(const structure::FrameModel& rival, std::uint64_t seed) const;
  [[nodiscard]] std::vector<double> differences(const structure::FrameModel& rival, const structure::FrameFit& fit,
                                                const Reference& reference, std::uint64_t seed) const;
  [[nodiscard]] std::vector<double> first_order_differences(const structure::FrameModel& rival,
                                                            const structure::FrameFit& fit, const Reference& reference,
                                                            std::uint64_t seed) const;

  void settle_numbers();
  [[nodiscard]] bool covers(const std::vector<int>& number) const;
  [[nodiscard]] std::optional<Reference> under_own_numbers(const structure::FrameModel& model,
                                                           const structure::FrameFit& fit) const;

  structure::DeclaredFrame declared_;
  Reference measured_, check_;
  // Numbers of measured_ in model_, 0: takes no part; and in model_ with each of open(), empty: the same.
  std::vector<int> number_;
  std::vector<std::vector<int>> candidate_number_;
  Reference reference_;  // those of measured_ that take part
  structure::FrameModel model_;
  structure::FrameFit fit_;
  structure::LeaveOneOut loo_;
  // Of another kind than a shear frame, about the last fit; empty where it cannot be formed.
  std::optional<structure::FirstOrderEffects> first_order_;
};

}  // namespace core::closure
