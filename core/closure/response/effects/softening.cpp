#include <algorithm>
#include <cmath>

#include "core/closure/response/effects/catalogue.h"
#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kMaterialSoftening = 0.004;  // records of linear structures show values up to this

// All frequencies follow the squared amplitude of the channel that moves most, as with a cubic spring. The amplitude is
// computed from earlier samples, so that a sample does not explain itself.
class Softening final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "softening"; }
  [[nodiscard]] bool has_course() const override { return true; }

  // Squared envelope divided by its mean, minus 1.
  [[nodiscard]] VectorXd course(const ChannelContext& context) const override {
    const VectorXd moved = motion(context.relative);
    const Index n = moved.size(), period = period_of(moved);
    VectorXd out = VectorXd::Zero(n);
    double sum = 0.0, counted = 0.0;
    for (Index k = 2 * period; k < n; ++k) {
      const double mean = moved.segment(k - 2 * period, 2 * period).mean();
      out(k) = (moved.segment(k - period, period).array() - mean).square().mean();
      sum += out(k), counted += 1.0;
    }
    if (!(sum > 0.0)) return VectorXd::Zero(n);
    for (Index k = 0; k < n; ++k) out(k) = k < 2 * period ? 0.0 : out(k) * counted / sum - 1.0;
    return out;
  }
  [[nodiscard]] double course_at_rest() const override { return -1.0; }
  [[nodiscard]] std::string repair() const override {
    return "put on a time along which the frequencies stay those of small motion";
  }
  [[nodiscard]] ParameterValue describe(double value) const override {
    return {"stiffness_change_at_mean_square", "%", 200.0 * value, {}};
  }
  [[nodiscard]] std::string immaterial(double value) const override {
    return std::abs(value) >= kMaterialSoftening
               ? ""
               : "linear structures show as much: " + number(200.0 * value) + " % of stiffness";
  }

 private:
  // Motion of the channel that moves most; gaps hold the previous value.
  static VectorXd motion(const ChannelRecord& record) {
    VectorXd best = VectorXd::Zero(record.n_samples());
    double most = -1.0;
    for (Index c = 0; c < record.value.cols(); ++c) {
      VectorXd own = record.value.col(c);
      double held = 0.0, squares = 0.0;
      for (double& v : own) {
        v = std::isfinite(v) ? v : held;
        held = v;
      }
      own.array() -= own.mean();
      squares = own.squaredNorm();
      if (squares > most) most = squares, best = own;
    }
    return best;
  }
  static Index period_of(const VectorXd& moved) {
    Index crossings = 0;
    for (Index k = 1; k < moved.size(); ++k) crossings += (moved(k) > 0.0) != (moved(k - 1) > 0.0) ? 1 : 0;
    return std::clamp<Index>(2 * moved.size() / std::max<Index>(crossings, 1), 4,
                             std::max<Index>(moved.size() / 20, 4));
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_softening() { return std::make_unique<Softening>(); }

}  // namespace core::closure
