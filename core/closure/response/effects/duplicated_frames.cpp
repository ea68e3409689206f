#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/closure/response/effects/catalogue.h"
#include "core/closure/response/effects/step_likelihood.h"

namespace core::closure {
namespace {

using Eigen::Index;

// In units of the innovations' standard deviation, in every channel: two different pictures differ by their noise; a
// repeated picture only by the tracker's different starting point.
constexpr double kSame = 0.02;
constexpr double kInserted = 3.0;  // ln of the likelihood ratio, over all repeated frames

// A picture delivered twice: all channels equal their previous sample. The second is not a sample. It either replaces a
// lost frame, or it was inserted between two frames: then all later samples are one step earlier.
class DuplicatedFrames final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "duplicated_frames"; }
  [[nodiscard]] bool corrects() const override { return true; }
  [[nodiscard]] bool is_of_the_clock() const override { return true; }
  [[nodiscard]] Corrected corrected(const ChannelContext& context) const override {
    const std::vector<Index> twice = places(context);
    if (twice.empty()) return {context.record};
    const StepLikelihood steps(context.scaled, context.predictor);
    double inserted = 0.0;
    for (const Index k : twice) inserted += steps.inserted(k);
    const auto n = static_cast<double>(twice.size());
    const bool are_inserted = inserted > kInserted;
    Corrected out{are_inserted ? without(context.record, twice) : blanked(context.record, twice), n,
                  by_chance(context)};
    out.words = are_inserted ? "inserted between frames: what follows them is moved up"
                             : "each in the place of a frame that is lost";
    return out;
  }
  [[nodiscard]] std::string repair() const override { return "repeated samples are removed"; }
  [[nodiscard]] ParameterValue describe(double value) const override { return {"duplicates", "frames", value, {}}; }

 private:
  static std::vector<Index> places(const ChannelContext& context) {
    const ChannelRecord& record = context.record;
    const ChannelPredictor& predictor = context.predictor;
    const Eigen::MatrixXd shape = predictor.whitener.triangularView<Eigen::Lower>().solve(
        Eigen::MatrixXd::Identity(predictor.n_channels, predictor.n_channels));
    const Eigen::RowVectorXd most =
        kSame * (shape.rowwise().norm().array() * predictor.deviation.array()).matrix().transpose();
    const Eigen::RowVectorXd most_of_input = kSame * typical_step(record.input);
    std::vector<Index> out;
    for (Index k = 1; k < record.n_samples(); ++k) {
      const bool same = is_within(record.value, k, most) && is_within(record.input, k, most_of_input);
      if (same) out.push_back(k);
    }
    return out;
  }
  static bool is_within(const Eigen::MatrixXd& value, Index k, const Eigen::RowVectorXd& most) {
    return ((value.row(k) - value.row(k - 1)).cwiseAbs().array() <= most.array()).all();  // false for NaN
  }
  static Eigen::RowVectorXd typical_step(const Eigen::MatrixXd& value) {
    Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(value.cols());
    for (Index c = 0; c < value.cols(); ++c) {
      double squares = 0.0, n = 0.0;
      for (Index k = 1; k < value.rows(); ++k) {
        const double step = value(k, c) - value(k - 1, c);
        if (std::isfinite(step)) squares += step * step, n += 1.0;
      }
      out(c) = n > 0.0 ? std::sqrt(squares / n) : 0.0;
    }
    return out;
  }
  // Square root of the expected number of pairs of different pictures that are equally similar by chance.
  static double by_chance(const ChannelContext& context) {
    const double one = kSame / std::sqrt(std::numbers::pi);
    const auto n = static_cast<double>(context.record.value.cols());
    return std::sqrt(static_cast<double>(context.record.n_samples()) * std::pow(one, n));
  }
  static ChannelRecord blanked(const ChannelRecord& record, const std::vector<Index>& places) {
    ChannelRecord out = record;
    for (const Index k : places) out.value.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
    return out;
  }
  static ChannelRecord without(const ChannelRecord& record, const std::vector<Index>& places) {
    ChannelRecord out = record;
    const Index n = record.n_samples() - static_cast<Index>(places.size());
    if (record.rate_is_average) out.rate_hz *= static_cast<double>(n) / static_cast<double>(record.n_samples());
    std::size_t next = 0;
    std::vector<Index> kept;
    for (Index k = 0; k < record.n_samples(); ++k) {
      if (next < places.size() && places[next] == k) {
        ++next;
        continue;
      }
      kept.push_back(k);
    }
    out.value = record.value(kept, Eigen::all).eval();
    out.input = record.input(kept, Eigen::all).eval();
    return out;
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_duplicated_frames() { return std::make_unique<DuplicatedFrames>(); }

}  // namespace core::closure
