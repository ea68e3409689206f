#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace core::closure {

// A matrix of 16-bit steps, where many of a record's size are kept: a quarter of the memory. An element is off by at
// most half a step, 1.5e-5 of the largest one.
class CompactField {
 public:
  explicit CompactField(const Eigen::MatrixXd& field)
      : step_(field.size() > 0 ? field.cwiseAbs().maxCoeff() / std::numeric_limits<std::int16_t>::max() : 0.0) {
    if (!(step_ > 0.0)) step_ = 1.0;
    steps_ = (field / step_).array().round().cast<std::int16_t>();
  }

  [[nodiscard]] Eigen::Index cols() const noexcept { return steps_.cols(); }
  [[nodiscard]] auto middleCols(Eigen::Index from, Eigen::Index count) const {
    return steps_.middleCols(from, count).cast<double>() * step_;
  }

 private:
  double step_;
  Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic> steps_;
};

}  // namespace core::closure
