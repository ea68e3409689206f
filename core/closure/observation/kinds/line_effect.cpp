#include "core/closure/observation/kinds/line_effect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/closure/observation/effects/rotation_patterns.h"
#include "core/closure/observation/kinds/materiality.h"
#include "core/closure/observation/line_search.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

constexpr double kWidest_hz = 2.0;   // half width; a wider band is a broad-band rotation
constexpr double kOtherOrder = 0.8;  // of a line's gain: the most that another alias order may reach
constexpr double kOfTails = 0.3;     // of the rms of a resonance: the most that lies outside its band
constexpr double kTails = 2.0;       // half widths beside its band in which they lie
constexpr double kOfPattern = 0.7;   // smallest share of the gain of the best pattern learned in its band

LineSearch search_in(const LineEffect& effect, const FitView& fit) {
  return {fit.model, fit.record.rate_hz, fit.readout_frames, effect.patterns(fit.model.geometry(), fit.readout_frames),
          fit.record.n_frames()};
}

class LineInModel final : public EffectInModel {
 public:
  LineInModel(const LineEffect& effect, const LineFinding& line)
      : EffectInModel(effect.id(), effect.name()), effect_(effect), line_(line) {}
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override { return std::make_unique<LineInModel>(*this); }
  [[nodiscard]] std::vector<ParameterValue> parameters(const FitView& fit,
                                                       const Eigen::RowVectorXd& /*amplitude*/) const override {
    const double true_hz = std::abs(hz_.apparent_hz + line_.fold * fit.record.rate_hz);
    if (!effect_.is_steady()) return band_parameters(true_hz);
    return {{"frequency", "Hz", true_hz, hz_.sigma_hz},
            {"apparent frequency", "Hz", hz_.apparent_hz, hz_.sigma_hz},
            {"gain over the next alias order", "", line_.gain - line_.next_gain, std::nullopt}};
  }
  void correct(CorrectionStage stage, const CorrectionView& /*view*/, Eigen::MatrixXd& positions) const override {
    if (stage == CorrectionStage::kVibration && motion_px_.size() > 0) positions -= motion_px_;
  }
  [[nodiscard]] Eigen::MatrixXd motion_px(const Eigen::RowVectorXd& /*amplitude*/) const override { return motion_px_; }
  // A resonance has tails, which cost more than they gain where three axes are free.
  [[nodiscard]] Leaves leaves() const override {
    return effect_.is_steady() ? Leaves{} : Leaves{kOfTails, kTails * line_.half_width_hz};
  }
  [[nodiscard]] bool is_refined() const override { return true; }
  void refine(const FitView& fit, const Eigen::RowVectorXd& /*amplitude*/) override {
    const LineSearch search = search_in(effect_, fit);
    const LineMotion more = search.motion(fit.model.residual(), line_, later_in_readout(fit.record, fit.predicted_px));
    const Eigen::MatrixXd before =
        motion_px_.size() > 0 ? motion_px_ : Eigen::MatrixXd::Zero(more.px.rows(), more.px.cols());
    motion_px_ = before + more.px;
    freedom_ = std::max(freedom_, more.freedom);  // of the first motion: what later rounds add is noise
    hz_ = search.frequency(motion_px_, line_);
    angles_ = search.angles(before, fit.model.residual(), line_);
  }
  [[nodiscard]] double freedom() const override { return freedom_; }

 private:
  [[nodiscard]] std::vector<ParameterValue> band_parameters(double true_hz) const {
    std::vector<ParameterValue> out{{"frequency", "Hz", true_hz, hz_.sigma_hz},
                                    {"half width", "Hz", line_.spread_hz, std::nullopt}};
    constexpr std::array kNames{"roll rms", "pitch rms", "yaw rms"};
    for (std::size_t axis = 0; axis < kNames.size(); ++axis)
      out.push_back({kNames[axis], "deg", kDegPerRad * angles_.rms[axis], kDegPerRad * angles_.sigma[axis]});
    return out;
  }

  const LineEffect& effect_;
  LineFinding line_;
  LineFrequency hz_;
  LineAngles angles_;
  Eigen::MatrixXd motion_px_;
  double freedom_ = 0.0;
};

class LineCandidate final : public EffectCandidate {
 public:
  LineCandidate(const LineEffect& effect, const FitView& fit)
      : effect_(effect), fit_(fit), search_(search_in(effect, fit)) {}
  // One search serves both kinds of line.
  [[nodiscard]] double gain(const TestedResidual& residual) const override {
    return effect_.is_steady() ? search_.find(residual.moments.spectrum).gain : 0.0;
  }
  double find(const TestedResidual& residual) override {
    found_ = search_.find(residual.moments.spectrum);
    return found_.gain;
  }
  [[nodiscard]] double material_share() const override { return kLineBar; }
  [[nodiscard]] Objection objection(const TestedResidual& residual) const override {
    if (found_.is_steady(fit_.record.rate_hz, fit_.readout_frames) != effect_.is_steady())
      return {effect_.is_steady() ? "it is a band, or slower than a rotor" : "it is the line of a steady rotor", false};
    if (!effect_.is_steady() && found_.spread_hz > kWidest_hz) return {"too wide for a band", false};
    if (found_.apparent_hz < LineSearch::kSlowest_hz && (found_.fold == 0 || !effect_.is_steady()))
      return {"a slow rotation", false};
    if (std::string words = of_structure(); !words.empty()) return {std::move(words), true};
    if (!(found_.gain < kOfPattern * search_.pattern_gain(residual.moments.spectrum, found_))) return {};
    return {"a projection of another effect: in its band the best learned pattern explains more", false};
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<LineInModel>(effect_, found_);
  }

 private:
  // At order 0, or where the rows do not determine the order, only roll is seen of a rotation, and a rocking structure
  // leaves the same.
  [[nodiscard]] std::string of_structure() const {
    const bool order_is_known = found_.next_gain < kOtherOrder * found_.gain;
    if (found_.fold != 0 && order_is_known) return {};
    RungSet band = 0;
    const Rungs& rungs = fit_.held_out.rungs();
    for (std::size_t i = 0; i < rungs.size(); ++i) {
      if (rungs.to_hz(i) > found_.apparent_hz - found_.half_width_hz &&
          rungs.from_hz(i) < found_.apparent_hz + found_.half_width_hz)
        band |= RungSet{1} << i;
    }
    return not_of_camera(roll_course(fit_, band), fit_);
  }

  const LineEffect& effect_;
  const FitView fit_;
  LineSearch search_;
  LineFinding found_;
};

}  // namespace

std::optional<NotObservable> LineEffect::obstacle(const FitView& fit, bool /*is_adopted*/) const {
  if (fit.readout_frames != 0.0) return std::nullopt;
  return NotObservable{
      "true frequency of a " + name(),
      "without a known readout time, frequencies that differ by the frame rate cannot be distinguished",
      "declare the readout time"};
}

std::unique_ptr<EffectCandidate> LineEffect::candidate(const FitView& fit) const {
  return std::make_unique<LineCandidate>(*this, fit);
}

}  // namespace core::closure
