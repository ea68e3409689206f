#pragma once

#include <Eigen/Core>
#include <vector>

namespace core::closure {

// Part of a motion that has one alias order.
struct AliasPart {
  int order = 0;           // not 0
  Eigen::MatrixXcd share;  // regions x regions: the regions' displacement -> its part of this order
};
using AliasSplit = std::vector<AliasPart>;  // the rest is of order 0; empty: all is

// Sums over the bins k of one strip of the spectrum, a: displacement of the regions, y: their shear, the inner product
// of the residual with the shear field of each.
struct AliasStrip {
  Eigen::Index from = 0, count = 0;  // bins
  Eigen::MatrixXcd moved;            // sum a a^H
  Eigen::MatrixXcd sheared;          // sum y a^H / i
  AliasSplit split = {};
};

// Splits the motion in each strip by alias order. A motion of order n has the shear i theta_n W a, with theta_n = n
// `radians` and W = `products`, the inner products of the shear fields. Modes have different shapes (complex: regions
// are read at different times), so that in the subspace of the strip's strongest shapes the shear is a linear function
// of the displacement, whose eigenvectors are the modes' shapes and whose eigenvalues are theta_n. Where one mode
// prevails the whole strip has one order. A strip needs evidence of its own, or a neighbour with that split and no
// evidence against it: peaks leak into neighbours.
void split_by_order(std::vector<AliasStrip>& strips, const Eigen::MatrixXd& products, double radians);

}  // namespace core::closure
