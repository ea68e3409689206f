#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/closure/response/effects/catalogue.h"
#include "core/closure/response/effects/step_likelihood.h"

namespace core::closure {
namespace {

using Eigen::Index;

// ln of the likelihood with drops over that without, for a given share of drops: by chance a ratio exceeds c with a
// probability below 1 / c, so that drops are reported in a record without any with a probability below exp(-6).
constexpr double kLogLikelihood = 6.0;
constexpr double kNever = -20.0;  // ln of the ratio if a drop does not explain the samples
constexpr double kLikely = 3.0;   // ln of a ratio above which neighbouring samples are doubtful, too
constexpr Index kCluster = 6;     // samples affected by one drop
constexpr double kUnsure = 0.75;  // of the correction for undetected drops: one standard deviation

// Frames are missing without being counted: the structure advanced by two steps between two samples, and the following
// samples confirm it.
class DroppedFrames final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "dropped_frames"; }
  [[nodiscard]] bool corrects() const override { return true; }
  [[nodiscard]] bool is_of_the_clock() const override { return true; }
  [[nodiscard]] Corrected corrected(const ChannelContext& context) const override {
    const EventCount drops = count_events(ratios(context));
    if (!(drops.evidence > kLogLikelihood)) return {context.record};
    std::vector<Index> before;
    for (const std::size_t k : drops.likely) before.push_back(static_cast<Index>(k));
    // Of drops within one cluster only one is detected, as by a counter with a dead time.
    const double blind =
        drops.count * static_cast<double>(kCluster - 1) / static_cast<double>(context.record.n_samples());
    const double count = drops.count / (1.0 - std::min(blind, 0.6));
    const double unsure = std::min(kUnsure * (count - drops.count), 0.25 * count);
    return {with_gaps(context.record, before), count, std::hypot(drops.sigma, unsure)};
  }
  [[nodiscard]] std::string repair() const override { return "lost samples are gaps"; }
  [[nodiscard]] ParameterValue describe(double value) const override { return {"drops", "frames", value, {}}; }

 private:
  static std::vector<double> ratios(const ChannelContext& context) {
    std::vector<double> out(static_cast<std::size_t>(context.scaled.n_samples()), kNever);
    const StepLikelihood steps(context.scaled, context.predictor);
    for (Index k = context.predictor.order; k < context.scaled.n_samples() && steps.ok(); ++k) {
      const StepLikelihood::Ratio ratio = steps.frame_missing(k);
      if (ratio.possible) out[static_cast<std::size_t>(k)] = std::max(ratio.own + ratio.after, kNever);
    }
    return best_of_neighbours(std::move(out));
  }
  // One drop makes its neighbours look like drops: keeps only the likeliest sample of each cluster.
  static std::vector<double> best_of_neighbours(std::vector<double> ratios) {
    const auto n = static_cast<Index>(ratios.size());
    for (Index k = 0; k < n; ++k) {
      const double own = ratios[static_cast<std::size_t>(k)];
      if (own < kLikely) continue;
      for (Index j = std::max<Index>(0, k - kCluster + 1); j < std::min(n, k + kCluster); ++j) {
        double& other = ratios[static_cast<std::size_t>(j)];
        if (j != k && (other < own || (other == own && j > k))) other = std::min(other, kNever);
      }
    }
    return ratios;
  }

  // If the rate is samples over duration, the duration is unchanged and contains more samples.
  static ChannelRecord with_gaps(const ChannelRecord& record, const std::vector<Index>& before) {
    ChannelRecord out = record;
    const Index n = record.n_samples() + static_cast<Index>(before.size());
    if (record.rate_is_average) out.rate_hz *= static_cast<double>(n) / static_cast<double>(record.n_samples());
    out.value.setConstant(n, record.value.cols(), std::numeric_limits<double>::quiet_NaN());
    out.input.setConstant(n, record.input.cols(), std::numeric_limits<double>::quiet_NaN());
    std::size_t next = 0;
    for (Index k = 0, to = 0; k < record.n_samples(); ++k, ++to) {
      if (next < before.size() && before[next] == k) ++next, ++to;
      out.value.row(to) = record.value.row(k);
      out.input.row(to) = record.input.row(k);
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_dropped_frames() { return std::make_unique<DroppedFrames>(); }

}  // namespace core::closure
