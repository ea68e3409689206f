#include "core/structure/fem/line_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix matrix_of(const Triplets& entries, Index n) {
  SparseMatrix out(n, n);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

// Numbers the degrees of freedom and gathers element matrices.
class LineMesh::Assembly {
 public:
  explicit Assembly(const LineMesh& mesh) : mesh_(mesh) {
    for (const Node& node : mesh.nodes_) {
      nodes_.push_back(node.dof);
      for (Index& dof : nodes_.back()) dof = dof == kFixed ? kFixed : n_++;
    }
    for (std::size_t i = 0; i < mesh.bars_.size(); ++i) {
      internal_.push_back(n_);
      n_ += mesh.basis(i).size() - 6;
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
    const Index n = mesh_.basis(i_bar).size();
    for (Index k = 6; k < n; ++k) out.push_back(internal_[i_bar] + k - 6);
    return out;
  }

  // From motion along and across the bar to x and z: the functions of its two ends are mixed.
  [[nodiscard]] MatrixXd rotation(std::size_t i_bar) const {
    const PlacedBar& bar = mesh_.bars_[i_bar];
    const Node &a = mesh_.nodes_[bar.from], &b = mesh_.nodes_[bar.to];
    const double length = std::hypot(b.x - a.x, b.z - a.z), c = (b.x - a.x) / length, s = (b.z - a.z) / length;
    const Index n = mesh_.basis(i_bar).size();
    MatrixXd out = MatrixXd::Identity(n, n);
    for (const Index end : {Index{0}, Index{3}}) {
      out(end, end) = c, out(end, end + 1) = s;
      out(end + 1, end) = -s, out(end + 1, end + 1) = c;
    }
    return out;
  }

  // The bar's last `count` degrees of freedom.
  [[nodiscard]] std::vector<Index> last_dofs(std::size_t i_bar, int count) const {
    const std::vector<Index> all = dofs(i_bar);
    return {all.end() - count, all.end()};
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

// Gathers terms of equal factors.
class LineMesh::Terms {
 public:
  Terms(const LineMesh& mesh, const Assembly& assembly) : mesh_(mesh), assembly_(assembly) {}

  void add(std::size_t bar, const Piece& piece) {
    Term& term = of(piece.factors, piece.power);
    assembly_.add(piece.is_mass ? term.mass : term.stiffness, bar, piece.matrix);
  }
  Triplets& stiffness(const std::vector<Factor>& factors, int power) { return of(factors, power).stiffness; }
  Triplets& mass(const std::vector<Factor>& factors, int power) { return of(factors, power).mass; }

  void build(AffineMatrices& out, Index n) const {
    out.stiffness = out.mass = SparseMatrix(n, n);
    for (const Term& term : terms_) {
      if (term.factors.empty()) {
        out.stiffness = matrix_of(term.stiffness, n), out.mass = matrix_of(term.mass, n);
        continue;
      }
      AffineTerm one{term.factors, {}, {}};
      if (!term.stiffness.empty()) one.stiffness = matrix_of(term.stiffness, n);
      if (!term.mass.empty()) one.mass = matrix_of(term.mass, n);
      out.terms.push_back(std::move(one));
    }
  }

 private:
  struct Term {
    std::vector<Factor> factors;
    Triplets stiffness, mass;
  };
  using Key = std::vector<std::tuple<std::size_t, Law, int, double, std::size_t>>;

  Term& of(std::vector<Factor> factors, int power) {
    if (mesh_.length_ && power != 0) factors.push_back(Factor::of_power(*mesh_.length_, power));
    Key key;
    for (const Factor& f : factors) key.emplace_back(f.parameter, f.law, f.power, f.least, f.at);
    const auto [found, is_new] = index_.emplace(key, terms_.size());
    if (is_new) terms_.push_back({std::move(factors), {}, {}});
    return terms_[found->second];
  }

  const LineMesh& mesh_;
  const Assembly& assembly_;
  std::vector<Term> terms_;
  std::map<Key, std::size_t> index_;
};

void LineMesh::add_bars(Terms& terms) const {
  for (std::size_t i = 0; i < bars_.size(); ++i) {
    for (const Piece& piece : pieces(i, basis(i))) terms.add(i, piece);
  }
  for (const RigidEnd& end : rigid_ends_) {
    for (const Piece& piece : changes_by(end)) terms.add(end.bar, piece);
  }
}

// Springs, links and masses.
void LineMesh::add_nodes(const Assembly& assembly, Terms& terms) const {
  for (const Spring& spring : springs_) {
    const auto d = static_cast<int>(assembly.dof(spring.node, spring.motion));
    if (d < 0) continue;
    const Factor factor = spring.law == Law::kReciprocal ? Factor::reciprocal(spring.parameter, spring.least)
                                                         : Factor::of_power(spring.parameter, 1);
    terms.stiffness({factor}, spring.motion == Motion::kTurn ? -2 : 0).emplace_back(d, d, 1.0);
  }
  for (const Link& link : links_) {
    const Node &a = nodes_[link.from], &b = nodes_[link.to];
    const double apart = std::hypot(b.x - a.x, b.z - a.z);
    const double c = apart > 0.0 ? (b.x - a.x) / apart : 1.0, s = apart > 0.0 ? (b.z - a.z) / apart : 0.0;
    const std::array<std::pair<Index, double>, 4> ends{{{assembly.dof(link.from, Motion::kX), -c},
                                                        {assembly.dof(link.from, Motion::kZ), -s},
                                                        {assembly.dof(link.to, Motion::kX), c},
                                                        {assembly.dof(link.to, Motion::kZ), s}}};
    Triplets& out = terms.stiffness({Factor::of_power(link.parameter, 1)}, 0);
    for (const auto& [i, of_i] : ends) {
      for (const auto& [j, of_j] : ends) {
        if (i >= 0 && j >= 0) out.emplace_back(static_cast<int>(i), static_cast<int>(j), of_i * of_j);
      }
    }
  }
  for (const Mass& mass : masses_) {
    std::vector<Factor> factors;
    if (mass.parameter) factors.push_back(Factor::of_power(*mass.parameter, 1));
    for (const Motion motion : {Motion::kX, Motion::kZ}) {
      const auto d = static_cast<int>(assembly.dof(mass.node, motion));
      if (d >= 0) terms.mass(factors, 0).emplace_back(d, d, mass.kg);
    }
  }
}

// Integral of the motion across all bars, by degree of freedom.
VectorXd LineMesh::across(const Assembly& assembly) const {
  VectorXd out = VectorXd::Zero(assembly.n_dof());
  const GaussRule rule = gauss_rule(n_points());
  for (std::size_t i = 0; i < bars_.size(); ++i) {
    const BarBasis shape = basis(i);
    VectorXd integral = VectorXd::Zero(shape.size());
    for (Index g = 0; g < rule.at.size(); ++g) integral += rule.weight(g) * shape.length() * shape.at(rule.at(g)).w;
    const VectorXd turned = assembly.rotation(i).transpose() * integral;
    const std::vector<Index> at = assembly.dofs(i);
    for (std::size_t d = 0; d < at.size(); ++d) {
      if (at[d] != kFixed) out(at[d]) += turned(static_cast<Index>(d));
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
  const BarBasis::Point p = basis(nearest).at(where);
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
  Terms terms(*this, assembly);
  add_bars(terms);
  add_nodes(assembly, terms);
  AffineMatrices out;
  out.kind = kind;
  out.parameters = parameters_;
  terms.build(out, n);
  if (!restraints_.empty()) {
    const VectorXd along = across(assembly);
    for (const Restraint& r : restraints_) {
      const MatrixXd square = r.factor * along * along.transpose();
      std::vector<Factor> factors{Factor::of_power(r.parameter, r.power)};
      if (length_) factors.push_back(Factor::of_power(*length_, 1));
      out.terms.push_back({std::move(factors), square.sparseView(), {}});
    }
  }
  for (const Shear& shear : shears_)
    out.rigid.push_back({shear.parameter, assembly.last_dofs(shear.bar, shear.functions)});
  out.readout = MatrixXd::Zero(static_cast<Index>(sights.size()), n);
  for (std::size_t i = 0; i < sights.size(); ++i)
    out.readout.row(static_cast<Index>(i)) = seen_by(sights[i], assembly, reach_m);
  out.sights = std::move(sights);
  out.drawing = drawing();
  return out;
}

}  // namespace core::structure
