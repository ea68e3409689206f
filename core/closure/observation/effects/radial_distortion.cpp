#include <cmath>
#include <vector>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/lens_effect.h"

namespace core::closure {
namespace {

constexpr double kSecondOfFirst = 0.35;  // |k2| over |k1| of calibrated lenses (0.2 ... 0.5)

// k1, or k1 and k2.
class RadialTerms : public LensEffect {
 public:
  explicit RadialTerms(Eigen::Index n) : n_(n) {}
  [[nodiscard]] EffectId id() const override { return {"radial_distortion"}; }
  [[nodiscard]] std::string name() const override { return "radial distortion"; }
  [[nodiscard]] std::vector<Parameter> constants() const override {
    return n_ == 1 ? std::vector<Parameter>{{"k1"}} : std::vector<Parameter>{{"k1"}, {"k2"}};
  }
  [[nodiscard]] double most() const override { return 1.0; }
  [[nodiscard]] double step() const override { return 1e-3; }

 protected:
  [[nodiscard]] LensCoefficients coefficients(const Eigen::VectorXd& values) const override {
    return {.k1 = values(0), .k2 = n_ == 1 ? 0.0 : values(1)};
  }

 private:
  Eigen::Index n_;
};

class RadialDistortion final : public RadialTerms {
 public:
  RadialDistortion() : RadialTerms(1) {}
  // k1 takes a part of k2 while k2 itself is too small to be adopted: what the record tells of k2 beside k1, together
  // with what lenses have.
  [[nodiscard]] Eigen::VectorXd left_out(const Eigen::VectorXd& values, const FitView& fit) const override {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(1);
    if (fit.lens.k2 != 0.0 || fit.lens.k3 != 0.0) return out;
    const std::vector<Eigen::MatrixXd> fields = RadialTerms(2).derivatives(Eigen::Vector2d(values(0), 0.0), fit);
    const double first = fields[0].squaredNorm(), both = fields[0].cwiseProduct(fields[1]).sum();
    const double beside = fields[1].squaredNorm() - both * both / first;
    const double prior = 1.0 / std::pow(kSecondOfFirst * values(0), 2);
    const Eigen::MatrixXd& residual = fit.model.residual();
    const double second = (fields[1] - both / first * fields[0]).cwiseProduct(residual).sum() / (beside + prior);
    out(0) = std::abs(both / first) * std::hypot(second, 1.0 / std::sqrt(beside + prior));
    return out;
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_radial_distortion() { return std::make_unique<RadialDistortion>(); }

}  // namespace core::closure
