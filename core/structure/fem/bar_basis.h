#pragma once

#include <Eigen/Core>

namespace core::structure {

// Shape functions of a straight bar of any degree (p version, Szabo & Babuska 1991). Degrees of freedom: u, w, turn of
// the first end, u, w, turn of the second end, then internal ones ("bubbles": integrated Legendre polynomials, which do
// not move the ends). u along the bar, w across it, turn: rotation of the cross-section, w' without shear flexibility.
// Errors of frequencies fall exponentially with the number of bubbles; matrices stay well conditioned. Shear in series:
// w = w_b + w_s with turn = w_b', so that the bar is rigid in shear where the functions of w_s are at rest: one of
// uniform shear that leaves the ends where they are, and integrated Legendre polynomials.
class BarBasis {
 public:
  // shear: w and turn independent (Timoshenko), else turn = w' (Euler-Bernoulli). axial: bubbles of u as well.
  // in_series: how many functions of w_s follow as the last degrees of freedom, without `shear` only.
  BarBasis(double length, int bubbles, bool shear, bool axial, int in_series = 0);

  // Values and derivatives along the bar of u, w and turn for every degree of freedom, at s = 0 .. 1 of the length.
  struct Point {
    Eigen::VectorXd u, du, w, dw, ddw, turn, dturn;
  };
  [[nodiscard]] Point at(double s) const;
  [[nodiscard]] Eigen::Index size() const noexcept;
  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] bool shear() const noexcept { return shear_; }

 private:
  void linear(double xi, Eigen::Index first, Eigen::Index last, Eigen::Index bubble, Eigen::VectorXd& value,
              Eigen::VectorXd& slope) const;
  void hermite(double xi, Point& out) const;
  void add_shear(double xi, Point& out) const;

  double length_;
  int bubbles_;
  bool shear_, axial_;
  int in_series_;
};

// Nodes on 0 .. 1 and weights of Gauss and Legendre's rule.
struct GaussRule {
  Eigen::VectorXd at, weight;
};
[[nodiscard]] GaussRule gauss_rule(int n);

}  // namespace core::structure
