// LineMesh: matrices of one bar.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/structure/fem/line_mesh.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t kEndPoints = 11;  // of a rigid end's length: interpolates frequencies to 1e-6 up to half a bar

double at_or_one(const std::function<double(double)>& factor, double s) { return factor ? factor(s) : 1.0; }

// Chebyshev's points of 0 .. most, both ends among them.
std::vector<double> end_points(double most) {
  std::vector<double> out;
  for (std::size_t i = 0; i < kEndPoints; ++i) {
    const double angle = std::numbers::pi * static_cast<double>(i) / static_cast<double>(kEndPoints - 1);
    out.push_back(0.5 * most * (1.0 - std::cos(angle)));
  }
  out.front() = 0.0, out.back() = most;
  return out;
}

}  // namespace

double LineMesh::length(std::size_t bar) const {
  const Node &a = nodes_[bars_[bar].from], &b = nodes_[bars_[bar].to];
  return std::hypot(b.x - a.x, b.z - a.z);
}

const LineMesh::Shear* LineMesh::shear_of(std::size_t bar) const {
  const auto found = std::find_if(shears_.begin(), shears_.end(), [&](const Shear& one) { return one.bar == bar; });
  return found == shears_.end() ? nullptr : &*found;
}

BarBasis LineMesh::basis(std::size_t bar, double length_m) const {
  const Shear* shear = shear_of(bar);
  return {length_m, bubbles_, bars_[bar].bar.shear.has_value(), axial_, shear == nullptr ? 0 : shear->functions};
}

// Bending, axial and shear stiffness, mass, and tensions of a bar with these shape functions.
std::vector<LineMesh::Piece> LineMesh::pieces(std::size_t i_bar, const BarBasis& shape) const {
  const Bar& bar = bars_[i_bar].bar;
  const Shear* shear = shear_of(i_bar);
  std::vector<Factor> part;
  if (bars_[i_bar].part) part.push_back(Factor::of_power(*bars_[i_bar].part, 1));
  const MatrixXd zero = MatrixXd::Zero(shape.size(), shape.size());
  Piece bending{part, -3, false, zero}, axial{part, -1, false, zero}, stiff_shear{part, -1, false, zero};
  Piece mass{{}, 1, true, zero}, rotary{{}, -1, true, zero}, series{{}, -1, false, zero};
  std::vector<Piece> tensions;
  for (const Tension& one : tensions_) {
    if (one.bar == i_bar) tensions.push_back({{Factor::of_power(one.parameter, 1)}, one.power, false, zero});
  }
  const GaussRule rule = gauss_rule(n_points());
  for (Index g = 0; g < rule.at.size(); ++g) {
    const double s = rule.at(g), dx = rule.weight(g) * shape.length();
    const BarBasis::Point p = shape.at(s);
    const double stiff = dx * at_or_one(bar.stiffness_along, s), heavy = dx * at_or_one(bar.mass_along, s);
    bending.matrix += stiff * bar.ei * p.dturn * p.dturn.transpose();
    if (axial_) axial.matrix += stiff * bar.ea * p.du * p.du.transpose();
    if (bar.shear) stiff_shear.matrix += heavy * *bar.shear * (p.dw - p.turn) * (p.dw - p.turn).transpose();
    if (shear != nullptr) series.matrix += heavy * shear->newton * (p.dw - p.turn) * (p.dw - p.turn).transpose();
    mass.matrix += heavy * bar.mass_per_m * (p.u * p.u.transpose() + p.w * p.w.transpose());
    if (bar.shear) rotary.matrix += heavy * bar.rotary_per_m * p.turn * p.turn.transpose();
    std::size_t t = 0;
    for (const Tension& one : tensions_) {
      if (one.bar == i_bar) tensions[t++].matrix += dx * one.newton(s) * p.dw * p.dw.transpose();
    }
  }
  std::vector<Piece> out{std::move(bending), std::move(mass)};
  if (axial_) out.push_back(std::move(axial));
  if (bar.shear) out.push_back(std::move(stiff_shear)), out.push_back(std::move(rotary));
  if (shear != nullptr) {
    series.factors = {Factor::reciprocal(shear->parameter, shear->least)};
    out.push_back(std::move(series));
  }
  for (Piece& one : tensions) out.push_back(std::move(one));
  return out;
}

// The same with a rigid end of this length: the rest of the bar hangs on the end's node by a rigid arm.
std::vector<LineMesh::Piece> LineMesh::pieces_with_rigid_end(const RigidEnd& end, double length_m) const {
  std::vector<Piece> out = pieces(end.bar, basis(end.bar, length(end.bar) - length_m));
  const Bar& bar = bars_[end.bar].bar;
  const Index w = end.is_last ? 4 : 1, turn = w + 1, u = w - 1;
  const double arm = end.is_last ? -length_m : length_m;
  for (Piece& piece : out) {
    MatrixXd arms = MatrixXd::Identity(piece.matrix.rows(), piece.matrix.cols());
    arms(w, turn) = arm;
    piece.matrix = arms.transpose() * piece.matrix * arms;
  }
  Piece& mass = *std::find_if(out.begin(), out.end(), [](const Piece& one) { return one.is_mass; });
  const double kg = bar.mass_per_m * length_m;
  mass.matrix(u, u) += kg, mass.matrix(w, w) += kg;
  mass.matrix(w, turn) += 0.5 * kg * arm, mass.matrix(turn, w) += 0.5 * kg * arm;
  mass.matrix(turn, turn) += kg * arm * arm / 3.0;
  return out;
}

// What a rigid end changes, interpolated in its length.
std::vector<LineMesh::Piece> LineMesh::changes_by(const RigidEnd& end) const {
  std::vector<Piece> out;
  const std::vector<Piece> without = pieces(end.bar, basis(end.bar));
  const std::vector<double> points = end_points(end.most_m);
  for (std::size_t k = 1; k < points.size(); ++k) {
    std::vector<Piece> with = pieces_with_rigid_end(end, points[k]);
    for (std::size_t i = 0; i < with.size(); ++i) {
      with[i].matrix -= without[i].matrix;
      with[i].factors.push_back({end.parameter, Law::kLagrange, 1, 0.0, points, k});
      out.push_back(std::move(with[i]));
    }
  }
  return out;
}

std::vector<DrawnItem> LineMesh::drawing() const {
  std::vector<DrawnItem> out;
  const auto place = [&](std::size_t node) { return Eigen::Vector2d(nodes_[node].x, nodes_[node].z); };
  for (const PlacedBar& bar : bars_) out.push_back({bar.part, place(bar.from), place(bar.to)});
  for (const Link& link : links_) out.push_back({link.parameter, place(link.from), place(link.to)});
  for (const RigidEnd& end : rigid_ends_) {
    const PlacedBar& bar = bars_[end.bar];
    const Eigen::Vector2d from = place(end.is_last ? bar.to : bar.from), to = place(end.is_last ? bar.from : bar.to);
    out.push_back({end.parameter, from, from + end.most_m / (to - from).norm() * (to - from)});
  }
  for (const Spring& spring : springs_) out.push_back({spring.parameter, place(spring.node), place(spring.node)});
  for (const Mass& mass : masses_) {
    if (mass.parameter) out.push_back({mass.parameter, place(mass.node), place(mass.node)});
  }
  return out;
}

}  // namespace core::structure
