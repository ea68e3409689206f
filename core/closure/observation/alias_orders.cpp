#include "core/closure/observation/alias_orders.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/linear/symmetric_eigen.h"

namespace core::closure {
namespace {

using Index = Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr int kMostOrders = 2;
constexpr Index kMostShapes = 4;     // in one strip
constexpr double kEvidence = 20.0;   // smallest decrease of the squares for each shape, in noise variances
constexpr double kOrderError = 0.3;  // largest deviation of the shear from that of its order, in orders
constexpr std::ptrdiff_t kNeighbours = 4;
constexpr double kLeastProduct = 1e-6;  // of the largest: less is absorbed by the model's columns

class OrderSplitter {
 public:
  OrderSplitter(const MatrixXd& products, double radians) : products_(products), radians_(radians) {
    const SymmetricEigen eigen(products);
    const Index n = (eigen.values().array() > kLeastProduct * eigen.values()(0)).count();
    const Eigen::VectorXd root = eigen.values().head(n).cwiseSqrt();
    const MatrixXd vectors = eigen.leading_vectors(n);
    to_white_ = root.asDiagonal() * vectors.transpose();
    from_white_ = vectors * root.cwiseInverse().asDiagonal();
  }

  // Squares of the shear of one order, in noise variances.
  [[nodiscard]] double power(const AliasStrip& strip) const {
    return (strip.moved.real().array() * products_.array()).sum() * radians_ * radians_;
  }

  // Decrease of the residual's squares, in noise variances.
  [[nodiscard]] double drop(const AliasStrip& strip, const AliasSplit& split) const {
    MatrixXcd shear = MatrixXcd::Zero(products_.rows(), products_.cols());
    for (const AliasPart& part : split) shear += part.order * radians_ * part.share;
    const MatrixXcd fitted = products_ * shear * strip.moved;
    return (shear.conjugate().array() * (2.0 * strip.sheared - fitted).array()).sum().real();
  }

  [[nodiscard]] AliasSplit of_own(const AliasStrip& strip) const {
    AliasSplit best;
    double most = 0.0;
    const auto take = [&](std::optional<AliasSplit> split, Index n_shapes) {
      if (!split || split->empty()) return;
      const double gain = drop(strip, *split) - kEvidence * static_cast<double>(n_shapes);
      if (gain > most) most = gain, best = std::move(*split);
    };
    take(of_one_order(strip), 1);
    const Index most_shapes = std::min(kMostShapes, to_white_.rows());
    if (most_shapes < 2) return best;
    const Shapes shapes(to_white_ * strip.moved * to_white_.transpose());
    if (shapes.info() != Eigen::Success) return best;
    for (Index n = 2; n <= most_shapes; ++n) take(of_shapes(strip, shapes, n), n);
    return best;
  }

 private:
  using Shapes = Eigen::SelfAdjointEigenSolver<MatrixXcd>;

  [[nodiscard]] static std::optional<int> order_of(std::complex<double> orders) {
    const int n = std::clamp(static_cast<int>(std::lround(orders.real())), -kMostOrders, kMostOrders);
    return std::abs(orders - static_cast<double>(n)) > kOrderError ? std::nullopt : std::optional(n);
  }

  [[nodiscard]] std::optional<AliasSplit> of_one_order(const AliasStrip& strip) const {
    const double all = power(strip);
    if (!(all > 0.0)) return std::nullopt;
    const std::optional<int> n = order_of(strip.sheared.trace().real() * radians_ / all);
    if (!n || *n == 0) return std::nullopt;
    return AliasSplit{{*n, MatrixXcd::Identity(products_.rows(), products_.cols())}};
  }

  // In the subspace of the n strongest shapes, each of its own order; empty: they have no orders.
  [[nodiscard]] std::optional<AliasSplit> of_shapes(const AliasStrip& strip, const Shapes& shapes, Index n) const {
    const Eigen::VectorXd power = shapes.eigenvalues().tail(n);  // ascending
    if (!(power(0) * radians_ * radians_ > kEvidence)) return std::nullopt;
    const MatrixXcd basis = shapes.eigenvectors().rightCols(n);
    const MatrixXcd sheared = basis.adjoint() * from_white_.transpose() * strip.sheared * to_white_.transpose() * basis;
    const Eigen::ComplexEigenSolver<MatrixXcd> solver(sheared * power.cwiseInverse().asDiagonal());
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::FullPivLU<MatrixXcd> lu(solver.eigenvectors());
    if (!lu.isInvertible()) return std::nullopt;
    const MatrixXcd dual = lu.inverse();
    AliasSplit out;
    for (Index i = 0; i < n; ++i) {
      const std::optional<int> order = order_of(solver.eigenvalues()(i) / radians_);
      if (!order) return std::nullopt;
      if (*order == 0) continue;
      const MatrixXcd share =
          from_white_ * basis * solver.eigenvectors().col(i) * dual.row(i) * basis.adjoint() * to_white_;
      const auto same = std::find_if(out.begin(), out.end(), [&](const AliasPart& p) { return p.order == *order; });
      if (same == out.end())
        out.push_back({*order, share});
      else
        same->share += share;
    }
    return out;
  }

  const MatrixXd& products_;
  double radians_;
  MatrixXd to_white_, from_white_;  // displacement <-> coordinates in which the shear fields are orthonormal
};

}  // namespace

void split_by_order(std::vector<AliasStrip>& strips, const Eigen::MatrixXd& products, double radians) {
  if (!(products.trace() > 0.0)) return;  // no region has a shear field of its own
  const OrderSplitter splitter(products, radians);
  std::vector<const AliasStrip*> decided;
  for (AliasStrip& strip : strips) {
    strip.split = splitter.of_own(strip);
    if (!strip.split.empty()) decided.push_back(&strip);
  }
  for (const AliasStrip* peak : decided) {
    const double power = splitter.power(*peak);
    for (const std::ptrdiff_t step : {-1, 1}) {
      for (std::ptrdiff_t i = peak - strips.data() + step, n = 0; n < kNeighbours; i += step, ++n) {
        if (i < 0 || i >= static_cast<std::ptrdiff_t>(strips.size())) break;
        AliasStrip& strip = strips[static_cast<std::size_t>(i)];
        if (!strip.split.empty() || splitter.power(strip) > power || splitter.drop(strip, peak->split) < -kEvidence)
          break;
        strip.split = peak->split;
      }
    }
  }
}

}  // namespace core::closure
