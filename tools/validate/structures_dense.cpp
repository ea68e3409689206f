// frame2d and matrices against dense matrices: textbook elements with cubic shapes, solved by Eigen.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/structure/kinds/frame2d.h"
#include "core/structure/kinds/matrices.h"
#include "tools/validate/structures.h"

namespace tools {
namespace {

using namespace core::structure;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Real = long double;
using Extended = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

struct Line {
  double x_1, z_1, x_2, z_2, ei, ea, kg_per_m;
};

// Consistent matrices of one element in its own axes: u, w, turn at both ends (Clough & Penzien, 10.3).
void element(Real l, const Line& line, Extended& k, Extended& m) {
  k = m = Extended::Zero(6, 6);
  const Real a = line.ea / l, b = line.ei / (l * l * l), g = line.kg_per_m * l / 420;
  for (const Index i : {0, 3}) {
    for (const Index j : {0, 3}) k(i, j) = i == j ? a : -a, m(i, j) = line.kg_per_m * l / (i == j ? 3 : 6);
  }
  const Index at[4] = {1, 2, 4, 5};
  Extended kb(4, 4), mb(4, 4);
  kb << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
      4 * l * l;
  mb << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l,
      -22 * l, 4 * l * l;
  for (Index i = 0; i < 4; ++i) {
    for (Index j = 0; j < 4; ++j) k(at[i], at[j]) += b * kb(i, j), m(at[i], at[j]) += g * mb(i, j);
  }
}

// Frequencies of lines in a chain, the first end and the last clamped, each of n elements. All in extended
// precision and as eigenvalues of K^-1 M: textbook elements lose digits with the fourth power of their number.
VectorXd chain_hz(const std::vector<Line>& lines, int n) {
  const Index nodes = static_cast<Index>(lines.size()) * n + 1;
  Extended k = Extended::Zero(3 * nodes, 3 * nodes), m = k;
  Index node = 0;
  for (const Line& line : lines) {
    const Real l = std::hypot(Real{line.x_2 - line.x_1}, Real{line.z_2 - line.z_1}), c = (line.x_2 - line.x_1) / l,
               s = (line.z_2 - line.z_1) / l;
    Extended turn = Extended::Identity(6, 6), ke, me;
    for (const Index i : {0, 3}) turn(i, i) = turn(i + 1, i + 1) = c, turn(i, i + 1) = s, turn(i + 1, i) = -s;
    element(l / n, line, ke, me);
    for (int i = 0; i < n; ++i, ++node) {
      k.block(3 * node, 3 * node, 6, 6) += turn.transpose() * ke * turn;
      m.block(3 * node, 3 * node, 6, 6) += turn.transpose() * me * turn;
    }
  }
  const Index free = 3 * (nodes - 2);
  const Extended kf = k.block(3, 3, free, free), mf = m.block(3, 3, free, free);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Extended> solver(mf, kf, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().reverse().head(6).cwiseInverse().cwiseSqrt().cast<double>() / (2.0 * std::numbers::pi);
}

KindError check_frame2d() {
  const std::vector<Line> lines{{0, 0, 0.4, 4.0, 3.0e6, 5.0e8, 120.0},
                                {0.4, 4.0, 6.1, 4.6, 5.0e6, 6.0e8, 210.0},
                                {6.1, 4.6, 6.0, 0, 2.4e6, 5.0e8, 110.0}};
  // Errors are a series in h^2, h^4 (linear axial shapes; bending), h^6: four meshes give the limit (Richardson).
  std::vector<VectorXd> hz;
  for (const int n : {8, 16, 32, 64}) hz.push_back(chain_hz(lines, n));
  for (double power = 4.0; hz.size() > 1; power *= 4.0) {
    for (std::size_t i = 0; i + 1 < hz.size(); ++i) hz[i] = (power * hz[i + 1] - hz[i]) / (power - 1.0);
    hz.pop_back();
  }
  const VectorXd& first = hz.front();
  Frame2d frame;
  frame.nodes = {{"a", 0, 0, 0, Connection::rigid(), Connection::rigid(), Connection::rigid()},
                 {"b", 0.4, 4.0, 0, {}, {}, {}},
                 {"c", 6.1, 4.6, 0, {}, {}, {}},
                 {"d", 6.0, 0, 0, Connection::rigid(), Connection::rigid(), Connection::rigid()}};
  const char* names[] = {"a", "b", "c", "d"};
  for (std::size_t i = 0; i < lines.size(); ++i)
    frame.members.push_back({std::string("m") + names[i],
                             names[i],
                             names[i + 1],
                             lines[i].ei,
                             lines[i].ea,
                             lines[i].kg_per_m,
                             {},
                             0.0,
                             {}});
  const auto model = make_frame2d(frame, {});
  const auto modes = model->modes(declared_values(*model), 6, {});
  KindError out{"frame2d", "leaning portal of unequal members", "dense matrices, extrapolated", 6, 1e9};
  if (modes && modes->frequency_hz.size() == 6)
    out.worst = (modes->frequency_hz.array() / first.array() - 1.0).abs().maxCoeff();
  return out;
}

// A net of masses and springs, rows x columns, held along one side; every mode of the dense matrices.
struct Net {
  MatrixXd k, m, group;
};
Net net(Index rows, Index columns) {
  const Index n = rows * columns;
  Net out{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
  const auto spring = [&](Index i, Index j, double stiffness, bool grouped) {
    for (MatrixXd* k : {&out.k, &out.group}) {
      if (k == &out.group && !grouped) continue;
      (*k)(i, i) += stiffness;
      if (j < 0) continue;
      (*k)(j, j) += stiffness;
      (*k)(i, j) -= stiffness;
      (*k)(j, i) -= stiffness;
    }
  };
  for (Index r = 0; r < rows; ++r) {
    for (Index c = 0; c < columns; ++c) {
      const Index i = r * columns + c;
      out.m(i, i) = 2.0 + 0.3 * std::sin(static_cast<double>(3 * r + 5 * c));
      const double stiffness = 4.0e4 * (1.0 + 0.2 * std::cos(static_cast<double>(r - 2 * c)));
      spring(i, c + 1 < columns ? i + 1 : -1, stiffness, r < rows / 3);
      if (r + 1 < rows) spring(i, i + columns, 1.3 * stiffness, r < rows / 3);
    }
  }
  return out;
}

std::vector<KindError> check_matrices() {
  const Net n = net(24, 17);
  MatrixStructure s;
  s.stiffness = n.k.sparseView(), s.mass = n.m.sparseView();
  s.groups.push_back({"first_rows", n.group.sparseView(), {}, 0.0});
  s.n_modes = 12;
  const auto hz = [&](double factor) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(n.k + (factor - 1.0) * n.group, n.m,
                                                                    Eigen::EigenvaluesOnly);
    return VectorXd(solver.eigenvalues().head(12).cwiseSqrt() / (2.0 * std::numbers::pi));
  };
  const auto worst = [](const VectorXd& a, const VectorXd& b) {
    return (a.array() / b.array() - 1.0).abs().maxCoeff();
  };
  const auto model = make_matrices(s);
  const auto modes = model->modes(declared_values(*model), 12, {});
  std::vector<KindError> out;
  out.push_back(
      {"matrices", "net of 408 masses", "dense matrices", 12, modes ? worst(modes->frequency_hz, hz(1.0)) : 1e9});
  out.push_back({"matrices", "the same with a group at 0.6", "dense matrices", 12,
                 worst(exact_modes(s, {0.6}, 12).frequency_hz, hz(0.6))});
  return out;
}

}  // namespace

std::vector<KindError> check_kinds_against_matrices() {
  std::vector<KindError> out{check_frame2d()};
  for (KindError& one : check_matrices()) out.push_back(std::move(one));
  return out;
}

}  // namespace tools
