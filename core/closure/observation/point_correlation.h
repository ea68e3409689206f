#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

namespace core::closure {

// How the noise of the tracked points of one region is correlated: shares of its variance. What is left is each point's
// own.
struct CorrelationShares {
  double window = 0.0;                    // common to points whose tracking windows overlap: noise of the pixels
  double neighbourhood = 0.0;             // common to neighbours, exp(-distance / 40 px): blocks of a codec
  double region_u = 0.0, region_v = 0.0;  // common to a whole region, along u and v: motion compensation of a codec

  [[nodiscard]] bool none() const noexcept { return along(0) + along(1) == 0.0; }
  [[nodiscard]] double along(Eigen::Index axis) const noexcept {
    return window + neighbourhood + (axis == 0 ? region_u : region_v);
  }
};

// Rows 2j and 2j + 1 (u and v) of the points of each region, in the order of the regions.
[[nodiscard]] std::vector<std::vector<Eigen::Index>> rows_by_region(const std::vector<std::size_t>& region_of_point);

// Correlation between the points `rows` of one region and axis (rows of places_px, 2 points long) of unit share, by
// kind.
[[nodiscard]] Eigen::MatrixXd window_overlap(const Eigen::VectorXd& places_px, const std::vector<Eigen::Index>& rows);
[[nodiscard]] Eigen::MatrixXd neighbourhood(const Eigen::VectorXd& places_px, const std::vector<Eigen::Index>& rows);

// Turns noise with these shares into independent noise of the same variance, by the symmetric inverse root of the
// correlation of each region and axis: the row of a point remains mostly its own. Plain data after construction.
class PointCorrelation {
 public:
  PointCorrelation() = default;  // independent noise: nothing is changed
  PointCorrelation(const CorrelationShares& shares, const std::vector<std::size_t>& region_of_point,
                   const Eigen::VectorXd& places_px);

  [[nodiscard]] const CorrelationShares& shares() const noexcept { return shares_; }
  // values: 2 points x any number of columns, real or complex, in sigmas.
  template <class Matrix>
  [[nodiscard]] Matrix removed(Matrix values) const {
    for (const Block& b : blocks_) apply(b.rows, b.inverse_root, values);
    return values;
  }
  template <class Matrix>
  [[nodiscard]] Matrix put_back(Matrix values) const {
    for (const Block& b : blocks_) apply(b.rows, b.root, values);
    return values;
  }

 private:
  struct Block {
    std::vector<Eigen::Index> rows;
    Eigen::MatrixXd root, inverse_root;
  };
  template <class Matrix>
  static void apply(const std::vector<Eigen::Index>& rows, const Eigen::MatrixXd& factor, Matrix& values) {
    using Scalar = typename Matrix::Scalar;
    const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> of_rows = values(rows, Eigen::all);
    values(rows, Eigen::all) = factor.template cast<Scalar>() * of_rows;
  }

  CorrelationShares shares_;
  std::vector<Block> blocks_;
};

}  // namespace core::closure
