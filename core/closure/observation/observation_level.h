#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/closure/closure_level.h"
#include "core/closure/effects/observation_effect.h"
#include "core/closure/observation/frame_model.h"
#include "core/closure/observation/leave_one_out.h"
#include "core/closure/observation/line_search.h"
#include "core/closure/observation/observation_record.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core::closure {

// Unit vector that explains most of a residual's squares, by power iteration from its largest value; zero if none.
[[nodiscard]] Eigen::VectorXd leading_pattern(const Eigen::MatrixXd& moments);

// Observation level: the model predicts the position of every point in every frame (FrameModel); residual in px.
// Cross-validation: leave-one-point-out in closed form (LeaveOneOut); constants of the record are fitted on nine of ten
// time blocks and scored on the tenth, latent patterns learned on four of five. Score = drop of held-out squares in
// noise variances; share = score / number of residual values, the unit of the materiality thresholds.
class ObservationLevel final : public ClosureLevel {
 public:
  // Materiality thresholds on the share: the model's own error does not reach them (core/closure/METHOD.md).
  static constexpr double kFullBandBar = 0.02;  // one amplitude per frame, and latent patterns
  static constexpr double kLowBandBar = 0.005;  // the same up to FrameModel::kLowBand_hz
  static constexpr double kGlobalBar = 0.003;   // constants of the record, spectral lines
  // A named effect must reach this share of the gain of the best pattern learned from the residual itself, and of the
  // squares above the noise; otherwise it is a projection of another effect.
  static constexpr double kOfLatent = 0.7, kOfExcess = 0.1;
  static constexpr double kRival = 0.9;  // of the score of the effect in whose place it stands
  static constexpr std::size_t kMostLatent = 8;
  static constexpr std::size_t kSurrogates = 12;  // evaluated by a Gumbel distribution; the thresholds are stricter

  // Throws std::invalid_argument with what check_record() says.
  explicit ObservationLevel(const ObservationRecord& record);

  // Reference modes from another source; shapes in the order of channel_names(), or empty. modes() then lists them,
  // with frequency 0 where none was found.
  void set_reference(std::vector<core::Mode> reference) { reference_ = std::move(reference); }
  [[nodiscard]] std::vector<std::string> channel_names() const;

  // Removes an effect from the catalogue (to test unknown effects).
  void forget(const std::string& effect);

  [[nodiscard]] std::string name() const override { return "observation"; }
  [[nodiscard]] std::string unit() const override { return "px"; }
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] std::vector<std::string> candidates() const override;
  LevelFit fit() override;
  [[nodiscard]] std::vector<CandidateScore> score() override;
  [[nodiscard]] double surrogate_score(std::uint64_t seed) override;
  void adopt(std::size_t candidate) override;
  void drop() override;
  [[nodiscard]] std::vector<ParameterValue> parameters(std::size_t adopted) const override;
  [[nodiscard]] std::string meaning(std::size_t adopted) const override;
  [[nodiscard]] std::vector<std::string> rivals(std::size_t adopted, std::uint64_t seed) override;
  [[nodiscard]] std::vector<ClosureMode> modes() const override;
  [[nodiscard]] std::optional<double> reference_error() const override;
  [[nodiscard]] std::string reference_unit() const override { return "%"; }
  [[nodiscard]] std::string describe_residual() const override;

  // Of the last fit.
  [[nodiscard]] const FrameModel& model() const noexcept { return model_; }
  [[nodiscard]] double readout_frames() const noexcept { return readout_frames_; }
  [[nodiscard]] const ObservationRecord& record() const noexcept { return record_; }  // of the usable points
  [[nodiscard]] Eigen::VectorXd mean_places_px() const { return measured_.rowwise().mean(); }
  [[nodiscard]] const core::ModalEstimate& estimate() const;  // of the regions' motion
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  static constexpr Eigen::Index kBlocks = 10, kLatentBlocks = 5;

  struct Adopted {
    ObservationEffect effect;
    EffectKind kind = EffectKind::kNamed;
    bool low_band = false;
    Eigen::VectorXd field;   // px per unit; latent: learned
    Eigen::VectorXd values;  // constants
    Eigen::MatrixXd covariance;
    LineFinding line;
    LineFrequency line_hz;
    Eigen::MatrixXd line_motion;
  };

  // Constants of a candidate: derivative fields in the model's residual space, and their products per time block.
  struct Derivatives {
    std::vector<Eigen::MatrixXd> fields;
    std::vector<Eigen::MatrixXd> normal;  // per block
  };

  // Second moments of a residual, from which all per-frame scores are computed.
  struct Moments {
    std::vector<Eigen::MatrixXd> all, low;  // by parts of the record: times, cosines
    Eigen::MatrixXd all_sum, low_sum;
  };

  struct Trial {
    double gain = 0.0;
    bool low_band = false;
    LineFinding line;
  };

  struct Channels {
    std::vector<core::ChannelInfo> info;
    std::vector<Eigen::Index> rows;  // of the model's amplitudes
  };
  [[nodiscard]] Channels channels() const;
  [[nodiscard]] std::vector<ObservationEffect> open() const;  // named, not adopted
  [[nodiscard]] std::size_t n_latent() const;
  [[nodiscard]] Eigen::MatrixXd corrected(bool solved);  // solved: with these effects before
  void fill_missing();
  void set_columns();
  [[nodiscard]] Eigen::Index amplitude_row(std::size_t adopted) const;  // of an adopted field
  [[nodiscard]] Eigen::VectorXd magnification(const Eigen::VectorXd& places_px) const;
  void take_out_turns(Eigen::MatrixXd& positions) const;
  [[nodiscard]] Eigen::MatrixXd later_in_readout() const;
  bool refine_constants();  // false: no constant changed by more than a twentieth of its sigma
  void refine_lines();
  [[nodiscard]] std::vector<Eigen::MatrixXd> derivatives_of(const ObservationEffect& effect,
                                                            const Eigen::VectorXd& values) const;
  void prepare_candidates();

  [[nodiscard]] Moments moments_of(const Eigen::MatrixXd& residual) const;
  [[nodiscard]] double heldout_squares(const Moments& moments) const;
  [[nodiscard]] Trial trial(std::size_t open_index, const Eigen::MatrixXd& residual, const Moments& moments) const;
  [[nodiscard]] Trial try_field(const Eigen::VectorXd& field, const Moments& moments) const;
  [[nodiscard]] double try_derivatives(const Derivatives& derivatives, const Eigen::MatrixXd& residual) const;
  [[nodiscard]] Trial try_latent(const Moments& moments) const;
  [[nodiscard]] double latent_gain(const std::vector<Eigen::MatrixXd>& parts, const Eigen::MatrixXd& sum,
                                   const LeaveOneOut& with) const;
  [[nodiscard]] std::string refusal(const ObservationEffect& effect, const Trial& trial, double latent_gain,
                                    double excess) const;
  [[nodiscard]] std::string follows_motion(const ObservationEffect& effect, bool low_band) const;
  [[nodiscard]] double low_share() const;  // of the record's degrees of freedom in time
  [[nodiscard]] double n_values() const;
  [[nodiscard]] double line_freedom() const;
  [[nodiscard]] double blur(double waves_per_px) const;

  std::vector<std::string> warnings_;  // before record_, whose making fills it
  ObservationRecord record_;
  std::vector<core::Mode> reference_;
  std::vector<ObservationEffect> registry_;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> missing_;  // row, frame
  Eigen::MatrixXd measured_;  // 2 points x frames, px; missing ones predicted by the model
  FrameModel model_;
  std::optional<LeaveOneOut> high_, low_;
  std::vector<Adopted> adopted_;
  double readout_frames_ = 0.0;
  Eigen::MatrixXd predicted_px_;                      // in the raw image, without the tracker's errors
  Eigen::MatrixXd tracker_error_px_;                  // of the adopted effects
  double sigma_px_ = 0.0;                             // rms over points
  std::vector<Derivatives> derivatives_;              // per open candidate; prepared once per fit
  std::vector<Trial> trials_;                         // of the last score(), latent last
  mutable std::optional<core::ModalEstimate> modes_;  // of the last fit(), once requested
};

}  // namespace core::closure
