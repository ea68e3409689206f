#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/closure/observation/kinds/absorbed_effect.h"
#include "core/closure/observation/observation_fit.h"
#include "core/closure/observation/observation_record.h"
#include "core/closure/observation/observation_scores.h"
#include "core/types/modal_estimate.h"

namespace core::closure {

// Observation level: the model predicts the position of every point in every frame; residual in px. Composed of the fit
// (ObservationFit), the scores of candidates on it (ObservationScores) and the report (observation_report.h).
class ObservationLevel final : public ClosureLevel {
 public:
  static constexpr std::size_t kSurrogates = 12;  // evaluated by a Gumbel distribution; the thresholds are stricter

  // Points that do not move with their region are excluded first (point_screening.h). Throws std::invalid_argument with
  // the faults reported by check_record().
  explicit ObservationLevel(ObservationRecord record);

  // Reference modes from another source; shapes in the order of channel_names(), or empty. modes() then lists these
  // modes, with frequency 0 where no identified mode matches.
  void set_reference(std::vector<core::Mode> reference) { reference_ = std::move(reference); }
  [[nodiscard]] std::vector<std::string> channel_names() const;

  // Removes an effect of this name from the catalogue (to test unknown effects).
  void forget(const std::string& effect);

  [[nodiscard]] std::string name() const override { return "observation"; }
  [[nodiscard]] std::string unit() const override { return "px"; }
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] std::vector<std::string> candidates() const override { return scores_.candidates(); }
  LevelFit fit() override;
  [[nodiscard]] std::vector<CandidateScore> score() override { return scores_.score(); }
  [[nodiscard]] double surrogate_score(std::uint64_t seed) override { return scores_.surrogate_score(seed); }
  void adopt(std::size_t candidate) override { fit_.add(scores_.adopted(candidate)); }
  void drop() override;
  // A latent pattern without which the held-out error is no larger; constants of which none differs from zero.
  std::optional<std::size_t> drop_needless() override;
  std::optional<std::size_t> drop_pretended() override;
  [[nodiscard]] double size_of(std::size_t adopted) const override;
  [[nodiscard]] std::vector<ParameterValue> parameters(std::size_t adopted) const override;
  [[nodiscard]] std::string meaning(std::size_t adopted) const override;
  [[nodiscard]] std::vector<std::string> rivals(std::size_t adopted, std::uint64_t seed) override;
  [[nodiscard]] std::vector<ClosureStep> absorbed() const override;
  [[nodiscard]] std::vector<ClosureMode> modes() const override;
  [[nodiscard]] std::optional<double> reference_error() const override;
  [[nodiscard]] std::string reference_unit() const override { return "%"; }
  [[nodiscard]] std::string describe_residual() const override;
  [[nodiscard]] Noise noise() const override;

  // State of the last fit.
  [[nodiscard]] const ObservationFit& state() const noexcept { return fit_; }
  [[nodiscard]] const core::ModalEstimate& estimate() const;  // modes of the regions' motion
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  [[nodiscard]] bool is_zero(std::size_t adopted) const;  // of constants: each within three sigmas of it
  [[nodiscard]] bool is_idle(std::size_t adopted);        // of a latent pattern; refits
  [[nodiscard]] bool camera_vibrates_at(double hz) const;
  [[nodiscard]] bool is_pretended(std::size_t adopted, const Eigen::MatrixXd& left) const;
  // In the free motions of the last fit().
  struct Found {
    const AbsorbedEffect* effect = nullptr;
    AbsorbedFinding finding;
  };
  [[nodiscard]] const std::vector<Found>& found() const;
  [[nodiscard]] std::vector<Found> find_absorbed() const;

  std::vector<std::string> warnings_;  // before fit_, whose making fills it
  ObservationFit fit_;
  std::vector<const ObservationEffect*> catalogue_;
  std::vector<const AbsorbedEffect*> absorbed_;
  ObservationScores scores_;
  std::vector<core::Mode> reference_;
  // Of the last fit(), computed on request.
  mutable std::optional<core::ModalEstimate> modes_;
  mutable std::optional<std::vector<Found>> found_;
};

}  // namespace core::closure
