#include "tools/validate/structures_elements.h"

#include <cmath>
#include <numbers>

namespace tools {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Rule {
  VectorXd at, weight;  // on 0 .. 1
};

constexpr double kRotary_m2 = 1e-8;

// By degree of freedom.
struct Motion {
  VectorXd w, dw, turn, dturn;
};

// Gauss and Legendre's rule (Abramowitz & Stegun 25.4.30), by Newton's method.
Rule rule_of(int n) {
  Rule out{VectorXd(n), VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double last = 1.0, own = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2.0 * k - 1.0) * x * own - (k - 1.0) * last) / k;
        last = own, own = next;
      }
      slope = n * (x * own - last) / (x * x - 1.0);
      x -= own / slope;
    }
    out.at(i) = 0.5 * (1.0 + x), out.weight(i) = 1.0 / ((1.0 - x * x) * slope * slope);
  }
  return out;
}

// Lagrange's polynomials of evenly spaced nodes on 0 .. 1, and their slopes.
void lagrange(double s, VectorXd& value, VectorXd& slope) {
  value = VectorXd::Ones(kShearNodes), slope = VectorXd::Zero(kShearNodes);
  const auto node = [](Index i) { return static_cast<double>(i) / static_cast<double>(kShearNodes - 1); };
  for (Index i = 0; i < kShearNodes; ++i) {
    for (Index k = 0; k < kShearNodes; ++k) {
      if (k == i) continue;
      double one = 1.0 / (node(i) - node(k));
      for (Index j = 0; j < kShearNodes; ++j) {
        if (j != i && j != k) one *= (s - node(j)) / (node(i) - node(j));
      }
      slope(i) += one;
      value(i) *= (s - node(k)) / (node(i) - node(k));
    }
  }
}

// Matrices of an element in its own axes, motion of a node: along, across, turn; added after the rotation to x and z.
void add_turned(MatrixXd& to, Index from, const PlaneElement& element, const MatrixXd& own) {
  const double l = std::hypot(element.along_x, element.along_z), c = element.along_x / l, s = element.along_z / l;
  MatrixXd turn = MatrixXd::Identity(own.rows(), own.cols());
  for (Index i = 0; i < own.rows(); i += 3)
    turn(i, i) = turn(i + 1, i + 1) = c, turn(i, i + 1) = s, turn(i + 1, i) = -s;
  to.block(3 * from, 3 * from, own.rows(), own.cols()) += turn.transpose() * own * turn;
}

}  // namespace

Matrix4d bending_element(double l) {
  Matrix4d k;
  k << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
      4 * l * l;
  return k / (l * l * l);
}

Matrix4d tension_element(double l) {
  Matrix4d k;
  k << 36, 3 * l, -36, 3 * l, 3 * l, 4 * l * l, -3 * l, -l * l, -36, -3 * l, 36, -3 * l, 3 * l, -l * l, -3 * l,
      4 * l * l;
  return k / (30.0 * l);
}

ElementMatrices shear_element(double l, double ei, double shear_stiffness, double mass_per_m) {
  const Index n = 2 * kShearNodes;
  ElementMatrices out{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
  const auto integrate = [&](int points, auto add) {
    const Rule rule = rule_of(points);
    VectorXd value, slope;
    for (Index g = 0; g < rule.at.size(); ++g) {
      lagrange(rule.at(g), value, slope);
      Motion p{VectorXd::Zero(n), VectorXd::Zero(n), VectorXd::Zero(n), VectorXd::Zero(n)};
      for (Index i = 0; i < kShearNodes; ++i) {
        p.w(2 * i) = p.turn(2 * i + 1) = value(i);
        p.dw(2 * i) = p.dturn(2 * i + 1) = slope(i) / l;
      }
      add(rule.weight(g) * l, p);
    }
  };
  integrate(static_cast<int>(kShearNodes) - 1, [&](double dx, const Motion& p) {
    const VectorXd shear = p.dw - p.turn;
    out.stiffness += dx * (ei * p.dturn * p.dturn.transpose() + shear_stiffness * shear * shear.transpose());
  });
  integrate(static_cast<int>(kShearNodes), [&](double dx, const Motion& p) {
    out.mass += dx * mass_per_m * (p.w * p.w.transpose() + kRotary_m2 * p.turn * p.turn.transpose());
  });
  return out;
}

void add_plane_element(MatrixXd& stiffness, MatrixXd& mass, Index from, const PlaneElement& element) {
  const double l = std::hypot(element.along_x, element.along_z), g = element.mass_per_m * l / 420.0;
  MatrixXd k = MatrixXd::Zero(6, 6), m = k;
  for (const Index i : {0, 3}) {
    for (const Index j : {0, 3}) {
      k(i, j) = (i == j ? 1.0 : -1.0) * element.ea / l;
      m(i, j) = (i == j ? 140.0 : 70.0) * g;
    }
  }
  const Index own[4] = {1, 2, 4, 5};
  const Matrix4d kb = element.ei * bending_element(l);
  Matrix4d mb;
  mb << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l,
      -22 * l, 4 * l * l;
  for (Index i = 0; i < 4; ++i) {
    for (Index j = 0; j < 4; ++j) k(own[i], own[j]) += kb(i, j), m(own[i], own[j]) += g * mb(i, j);
  }
  add_turned(stiffness, from, element, k);
  add_turned(mass, from, element, m);
}

void add_plane_shear_element(MatrixXd& stiffness, MatrixXd& mass, Index from, const PlaneElement& element,
                             double shear_stiffness) {
  const double l = std::hypot(element.along_x, element.along_z);
  const ElementMatrices bent = shear_element(l, element.ei, shear_stiffness, element.mass_per_m);
  MatrixXd k = MatrixXd::Zero(3 * kShearNodes, 3 * kShearNodes), m = k;
  for (Index i = 0; i < kShearNodes; ++i) {
    for (Index j = 0; j < kShearNodes; ++j) {
      k.block(3 * i + 1, 3 * j + 1, 2, 2) = bent.stiffness.block(2 * i, 2 * j, 2, 2);
      m.block(3 * i + 1, 3 * j + 1, 2, 2) = bent.mass.block(2 * i, 2 * j, 2, 2);
      m(3 * i, 3 * j) = bent.mass(2 * i, 2 * j);
    }
  }
  const double step = l / static_cast<double>(kShearNodes - 1);
  for (Index i = 0; i + 1 < kShearNodes; ++i) {  // stretching, by linear elements
    for (const Index a : {i, i + 1}) {
      for (const Index b : {i, i + 1}) k(3 * a, 3 * b) += (a == b ? 1.0 : -1.0) * element.ea / step;
    }
  }
  add_turned(stiffness, from, element, k);
  add_turned(mass, from, element, m);
}

}  // namespace tools
