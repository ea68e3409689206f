#include <cmath>

#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

constexpr double kWhole = 0.25;    // of a frame: tolerance of a whole number of frames
constexpr Eigen::Index kEdge = 8;  // readings on either side

// At one frame the clock jumps ahead of the frame numbers: frames were lost there without being counted.
class ClockLostFrames final : public ClockEffect {
 public:
  [[nodiscard]] std::string name() const override { return "lost_frames"; }

  // The step that reduces the residual's squares most, by sums over the available readings.
  [[nodiscard]] Eigen::VectorXd place(const Eigen::VectorXd& frame, const Eigen::VectorXd& residual_s,
                                      const std::vector<char>& seen) const override {
    double n = 0.0, sum = 0.0;
    for (Eigen::Index i = 0; i < frame.size(); ++i) {
      if (seen[static_cast<std::size_t>(i)] == 0) continue;
      n += 1.0;
      sum += residual_s(i);
    }
    double before_n = 0.0, before_sum = 0.0, best = -1.0;
    Eigen::Index first = 0;
    Eigen::VectorXd out = Eigen::VectorXd::Constant(1, frame(frame.size() / 2));
    for (Eigen::Index i = 0; i < frame.size(); ++i) {
      const double after_n = n - before_n, after_sum = sum - before_sum;
      if (before_n >= kEdge && after_n >= kEdge) {
        const double gain = before_sum * before_sum / before_n + after_sum * after_sum / after_n;
        // A step between two available readings is placed in the middle.
        if (gain > best) best = gain, first = i;
        if (gain == best) out(0) = frame((first + i) / 2);
      }
      if (seen[static_cast<std::size_t>(i)] == 0) continue;
      before_n += 1.0;
      before_sum += residual_s(i);
    }
    return out;
  }
  [[nodiscard]] Eigen::MatrixXd columns(const Eigen::VectorXd& frame, double /*last*/,
                                        const Eigen::VectorXd& place) const override {
    return (frame.array() >= place(0)).cast<double>().matrix();
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const Eigen::VectorXd& coefficients,
                                                       const Eigen::VectorXd& place, double rate_hz,
                                                       double /*last*/) const override {
    return {{"lost", "frames", coefficients(0) * rate_hz, {}}, {"before_frame", "1", place(0), {}}};
  }
  [[nodiscard]] std::string implausible(const Eigen::VectorXd& coefficients, double rate_hz) const override {
    const double lost = coefficients(0) * rate_hz;
    return lost > 0.5 && std::abs(lost - std::round(lost)) < kWhole ? ""
                                                                    : "the step is not a whole number of lost frames";
  }
};

}  // namespace

std::unique_ptr<ClockEffect> make_clock_lost_frames() { return std::make_unique<ClockLostFrames>(); }

}  // namespace core::closure
