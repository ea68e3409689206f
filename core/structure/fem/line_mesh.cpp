#include "core/structure/fem/line_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kTaperPoints = 4;  // more points of the rule than the shape functions alone need

SparseMatrix matrix_of(const std::vector<Eigen::Triplet<double>>& entries, Index n) {
  SparseMatrix out(n, n);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

double at_or_one(const std::function<double(double)>& factor, double s) { return factor ? factor(s) : 1.0; }

}  // namespace

// Numbers the degrees of freedom and gathers element matrices.
class LineMesh::Assembly {
 public:
  explicit Assembly(const LineMesh& mesh) : mesh_(mesh) {
    for (const Node& node : mesh.nodes_) {
      nodes_.push_back(node.dof);
      for (Index& dof : nodes_.back()) dof = dof == kFixed ? kFixed : n_++;
    }
    for (const PlacedBar& bar : mesh.bars_) {
      internal_.push_back(n_);
      n_ += mesh.basis(bar).size() - 6;
    }
  }

  [[nodiscard]] Index n_dof() const noexcept { return n_; }
  [[nodiscard]] Index dof(std::size_t node, Motion motion) const {
    return nodes_[node][static_cast<std::size_t>(motion)];
  }

  // Degrees of freedom of a bar's shape functions after the rotation to x and z.
  [[nodiscard]] std::vector<Index> dofs(std::size_t i_bar) const {
    const PlacedBar& bar = mesh_.bars_[i_bar];
    std::vector<Index> out;
    for (const std::size_t node : {bar.from, bar.to}) out.insert(out.end(), nodes_[node].begin(), nodes_[node].end());
    const Index n = mesh_.basis(bar).size();
    for (Index k = 6; k < n; ++k) out.push_back(internal_[i_bar] + k - 6);
    return out;
  }

  // From motion along and across the bar to x and z: the functions of its two ends are mixed.
  [[nodiscard]] MatrixXd rotation(std::size_t i_bar) const {
    const PlacedBar& bar = mesh_.bars_[i_bar];
    const Node &a = mesh_.nodes_[bar.from], &b = mesh_.nodes_[bar.to];
    const double length = std::hypot(b.x - a.x, b.z - a.z), c = (b.x - a.x) / length, s = (b.z - a.z) / length;
    const Index n = mesh_.basis(bar).size();
    MatrixXd out = MatrixXd::Identity(n, n);
    for (const Index end : {Index{0}, Index{3}}) {
      out(end, end) = c, out(end, end + 1) = s;
      out(end + 1, end) = -s, out(end + 1, end + 1) = c;
    }
    return out;
  }

  void add(Triplets& out, std::size_t i_bar, const MatrixXd& element) const {
    const MatrixXd turned = rotation(i_bar).transpose() * element * rotation(i_bar);
    const std::vector<Index> at = dofs(i_bar);
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j < at.size(); ++j) {
        if (at[i] == kFixed || at[j] == kFixed) continue;
        out.emplace_back(static_cast<int>(at[i]), static_cast<int>(at[j]),
                         turned(static_cast<Index>(i), static_cast<Index>(j)));
      }
    }
  }

 private:
  const LineMesh& mesh_;
  std::vector<std::array<Index, 3>> nodes_;
  std::vector<Index> internal_;
  Index n_ = 0;
};

std::size_t LineMesh::add_node(double x_m, double z_m) {
  nodes_.push_back({x_m, z_m});
  return nodes_.size() - 1;
}

std::size_t LineMesh::add_parameter(ModelParameter parameter) {
  parameters_.push_back(std::move(parameter));
  return parameters_.size() - 1;
}

std::size_t LineMesh::add_bar(std::size_t from, std::size_t to, const Bar& bar, std::optional<std::size_t> part) {
  bars_.push_back({from, to, bar, part});
  return bars_.size() - 1;
}

void LineMesh::add_tension(std::size_t bar, const std::function<double(double)>& newton, std::size_t parameter) {
  tensions_.push_back({bar, parameter, newton});
}

void LineMesh::add_spring(std::size_t node, Motion motion, std::size_t parameter, Law law, double least) {
  springs_.push_back({node, parameter, motion, law, least});
}

void LineMesh::add_mass(std::size_t node, double kg, std::optional<std::size_t> parameter) {
  masses_.push_back({node, kg, parameter});
}

void LineMesh::add_uniform_restraint(double factor, std::size_t parameter, Law law) {
  restraints_.push_back({factor, parameter, law});
}

BarBasis LineMesh::basis(const PlacedBar& bar) const {
  const Node &a = nodes_[bar.from], &b = nodes_[bar.to];
  return {std::hypot(b.x - a.x, b.z - a.z), bubbles_, bar.bar.shear.has_value(), axial_};
}

// All bars: matrices by parameter, and the integral of the motion across the bars.
LineMesh::Gathered LineMesh::gather(const Assembly& assembly) const {
  Gathered out;
  out.linear.resize(parameters_.size()), out.added.resize(parameters_.size());
  out.across = VectorXd::Zero(assembly.n_dof());
  const GaussRule rule = gauss_rule(bubbles_ + 4 + kTaperPoints);
  for (std::size_t i = 0; i < bars_.size(); ++i) {
    const Bar& bar = bars_[i].bar;
    const BarBasis shape = basis(bars_[i]);
    MatrixXd k = MatrixXd::Zero(shape.size(), shape.size()), m = k;
    VectorXd integral = VectorXd::Zero(shape.size());
    for (Index g = 0; g < rule.at.size(); ++g) {
      const double s = rule.at(g), dx = rule.weight(g) * shape.length();
      const BarBasis::Point p = shape.at(s);
      const double stiff = dx * at_or_one(bar.stiffness_along, s), heavy = dx * at_or_one(bar.mass_along, s);
      k += stiff * bar.ei * p.dturn * p.dturn.transpose();
      if (axial_) k += stiff * bar.ea * p.du * p.du.transpose();
      if (bar.shear) k += stiff * *bar.shear * (p.dw - p.turn) * (p.dw - p.turn).transpose();
      m += heavy * bar.mass_per_m * (p.u * p.u.transpose() + p.w * p.w.transpose());
      if (bar.shear) m += heavy * bar.rotary_per_m * p.turn * p.turn.transpose();
      integral += dx * p.w;
    }
    assembly.add(bars_[i].part ? out.linear[*bars_[i].part] : out.stiffness, i, k);
    assembly.add(out.mass, i, m);
    const VectorXd turned = assembly.rotation(i).transpose() * integral;
    const std::vector<Index> at = assembly.dofs(i);
    for (std::size_t d = 0; d < at.size(); ++d) {
      if (at[d] != kFixed) out.across(at[d]) += turned(static_cast<Index>(d));
    }
  }
  for (const Tension& tension : tensions_) {
    const BarBasis shape = basis(bars_[tension.bar]);
    MatrixXd k = MatrixXd::Zero(shape.size(), shape.size());
    for (Index g = 0; g < rule.at.size(); ++g) {
      const VectorXd slope = shape.at(rule.at(g)).dw;
      k += rule.weight(g) * shape.length() * tension.newton(rule.at(g)) * slope * slope.transpose();
    }
    assembly.add(out.linear[tension.parameter], tension.bar, k);
  }
  for (const Mass& mass : masses_) {
    for (const Motion motion : {Motion::kX, Motion::kZ}) {
      const auto d = static_cast<int>(assembly.dof(mass.node, motion));
      if (d >= 0) (mass.parameter ? out.added[*mass.parameter] : out.mass).emplace_back(d, d, mass.kg);
    }
  }
  return out;
}

// Motion that a sight sees, by degree of freedom.
VectorXd LineMesh::seen_by(const Sight& sight, const Assembly& assembly, double reach_m) const {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity(), where = 0.0;
  const Eigen::Vector2d place(sight.at_m.x(), sight.at_m.z());
  for (std::size_t b = 0; b < bars_.size(); ++b) {
    const Eigen::Vector2d from(nodes_[bars_[b].from].x, nodes_[bars_[b].from].z);
    const Eigen::Vector2d along = Eigen::Vector2d(nodes_[bars_[b].to].x, nodes_[bars_[b].to].z) - from;
    const double s = std::clamp((place - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double off = (place - from - s * along).norm();
    if (off < least) least = off, where = s, nearest = b;
  }
  if (!(least <= reach_m)) {
    std::ostringstream text;
    text << "`" << sight.channel << "` lies " << least << " m from the structure (allowed: " << reach_m
         << " m); check at_m and its unit (m)";
    throw std::invalid_argument(text.str());
  }
  const BarBasis::Point p = basis(bars_[nearest]).at(where);
  const MatrixXd rotation = assembly.rotation(nearest);
  const double c = rotation(0, 0), s = rotation(0, 1);
  const VectorXd seen =
      rotation.transpose() * (sight.direction.x() * (c * p.u - s * p.w) + sight.direction.z() * (s * p.u + c * p.w));
  const std::vector<Index> at = assembly.dofs(nearest);
  VectorXd out = VectorXd::Zero(assembly.n_dof());
  for (std::size_t d = 0; d < at.size(); ++d) {
    if (at[d] != kFixed) out(at[d]) += seen(static_cast<Index>(d));
  }
  return out;
}

AffineMatrices LineMesh::build(const char* kind, std::vector<Sight> sights, double reach_m) const {
  const Assembly assembly(*this);
  const Index n = assembly.n_dof();
  const Gathered gathered = gather(assembly);
  AffineMatrices out;
  out.kind = kind;
  out.parameters = parameters_;
  out.stiffness = matrix_of(gathered.stiffness, n), out.mass = matrix_of(gathered.mass, n);
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    if (gathered.linear[p].empty() && gathered.added[p].empty()) continue;
    AffineTerm term;
    term.parameter = p;
    if (!gathered.linear[p].empty()) term.stiffness = matrix_of(gathered.linear[p], n);
    if (!gathered.added[p].empty()) term.mass = matrix_of(gathered.added[p], n);
    out.terms.push_back(std::move(term));
  }
  for (const Spring& spring : springs_) {
    const auto d = static_cast<int>(assembly.dof(spring.node, spring.motion));
    if (d >= 0) out.terms.push_back({spring.parameter, spring.law, spring.least, matrix_of({{d, d, 1.0}}, n), {}});
  }
  for (const Restraint& r : restraints_) {
    const MatrixXd square = r.factor * gathered.across * gathered.across.transpose();
    out.terms.push_back({r.parameter, r.law, 0.0, square.sparseView(), {}});
  }
  out.readout = MatrixXd::Zero(static_cast<Index>(sights.size()), n);
  for (std::size_t i = 0; i < sights.size(); ++i)
    out.readout.row(static_cast<Index>(i)) = seen_by(sights[i], assembly, reach_m);
  out.sights = std::move(sights);
  return out;
}

}  // namespace core::structure
