#include "core/structure/kinds/frame2d.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/structure/kinds/declared_value.h"

namespace core::structure {
namespace {

constexpr std::size_t kMostNodes = 60, kMostMembers = 60;
constexpr int kMostBubbles = 14;  // of a member along and across

class Frame2dBuilder {
 public:
  explicit Frame2dBuilder(const Frame2d& frame)
      : frame_(frame), mesh_(true, std::min(bubbles_for(frame.members.size()), kMostBubbles)) {}

  AffineMatrices build(std::vector<Sight> sights) {
    if (frame_.nodes.size() > kMostNodes || frame_.members.empty() || frame_.members.size() > kMostMembers)
      refuse_declaration(frame_.nodes.size(), " nodes and ", frame_.members.size(), " members are refused: up to ",
                         kMostNodes, " nodes and 1 .. ", kMostMembers, " members; use kind: matrices");
    for (const Frame2d::Node& node : frame_.nodes) add_node(node);
    for (const Frame2d::Member& member : frame_.members) add_member(member);
    for (const Frame2d::Node& node : frame_.nodes) add_connections(node);
    for (const Frame2d::Coupling& coupling : frame_.couplings) add_coupling(coupling);
    add_shear();
    for (std::size_t i = 0; i < frame_.members.size(); ++i) add_rigid_ends(i);
    mesh_.set_length(mesh_.add_parameter(length_parameter()));
    return mesh_.build("frame2d", std::move(sights), 0.5 * largest_);
  }

 private:
  void add_node(const Frame2d::Node& node) {
    require_value(node.x_m, -1e5, 1e5, "nodes " + node.name + " x_m");
    require_value(node.z_m, -1e5, 1e5, "nodes " + node.name + " z_m");
    if (!nodes_.emplace(node.name, mesh_.add_node(node.x_m, node.z_m)).second)
      refuse_declaration("nodes: `", node.name, "` stands twice; name each node once");
  }
  [[nodiscard]] std::size_t node(const std::string& name, const std::string& of) const {
    const auto found = nodes_.find(name);
    if (found == nodes_.end()) refuse_declaration(of, ": there is no node `", name, "`; add it under nodes");
    return found->second;
  }
  [[nodiscard]] double length_of(const Frame2d::Member& member) const {
    const auto &a = frame_.nodes[nodes_.at(member.from)], &b = frame_.nodes[nodes_.at(member.to)];
    return std::hypot(b.x_m - a.x_m, b.z_m - a.z_m);
  }
  void add_member(const Frame2d::Member& member) {
    const std::string of = "members " + member.name;
    const std::size_t from = node(member.from, of), to = node(member.to, of);
    const double length = length_of(member);
    require_value(length, 1e-4, 1e5, "members " + member.name + ": length");
    require_value(member.ei_nm2, 1e-9, 1e18, "members " + member.name + " ei_nm2");
    require_value(member.ea_n, 1e-9, 1e18, "members " + member.name + " ea_n");
    require_value(member.mass_per_m_kg, 0.0, 1e9, "members " + member.name + " mass_per_m_kg");
    if (member.shear_n) require_value(*member.shear_n, 1e-6, 1e18, "members " + member.name + " shear_n");
    require_value(member.axial_n, -1e15, 1e15, "members " + member.name + " axial_n");
    largest_ = std::max(largest_, length), ei_ = std::max(ei_, member.ei_nm2);
    total_kg_ += length * member.mass_per_m_kg;
    Bar bar;
    bar.ei = member.ei_nm2, bar.ea = member.ea_n, bar.mass_per_m = member.mass_per_m_kg, bar.shear = member.shear_n;
    const std::size_t number = mesh_.add_bar(from, to, bar, part_of(member));
    if (member.axial_n == 0.0) return;
    ModelParameter p;
    p.name = "axial_force_" + member.name, p.unit = "N", p.role = Role::kAxialForce, p.place = member.name;
    p.value = member.axial_n, p.scale = 0.2 * std::abs(member.axial_n);
    p.low = -50.0 * std::abs(member.axial_n), p.high = 50.0 * std::abs(member.axial_n);
    mesh_.add_tension(
        number, [](double) { return 1.0; }, mesh_.add_parameter(std::move(p)));
  }
  std::size_t part_of(const Frame2d::Member& member) {
    const std::string name = member.group.empty() ? member.name : member.group;
    const auto found = parts_.find(name);
    if (found != parts_.end()) return found->second;
    ModelParameter p;
    p.name = "stiffness_" + name, p.unit = "1", p.role = Role::kPartStiffness, p.place = name;
    p.value = 1.0, p.low = 0.01, p.high = 50.0, p.scale = 0.2, p.prior_sigma = frame_.part_prior;
    return parts_[name] = mesh_.add_parameter(std::move(p));
  }
  void add_connections(const Frame2d::Node& node) {
    const std::size_t at = nodes_.at(node.name);
    const double l = largest_, across = ei_ / (l * l * l), turning = ei_ / l;
    const bool held = node.x.kind != Connection::Kind::kFree || node.z.kind != Connection::Kind::kFree;
    connect(mesh_, at, Motion::kX, node.x, across, "support_" + node.name + "_x", node.name, frame_.spring_prior);
    connect(mesh_, at, Motion::kZ, node.z, across, "support_" + node.name + "_z", node.name, frame_.spring_prior);
    if (held || node.rotation.kind != Connection::Kind::kFree)
      connect(mesh_, at, Motion::kTurn, node.rotation, turning, "support_" + node.name + "_rotation", node.name,
              frame_.spring_prior);
    require_value(node.mass_kg, 0.0, 1e12, "nodes " + node.name + " mass_kg");
    if (node.mass_kg > 0.0) mesh_.add_mass(at, node.mass_kg, std::nullopt);
    if (!held) add_possible_mass(mesh_, at, std::max(total_kg_, 1e-9), "mass_" + node.name, node.name);
  }

  void add_coupling(const Frame2d::Coupling& coupling) {
    const std::string name = coupling.from + "-" + coupling.to, of = "couplings " + name;
    const std::size_t from = node(coupling.from, of), to = node(coupling.to, of);
    if (from == to) refuse_declaration(of, ": it couples a node with itself; name two nodes");
    require_value(coupling.stiffness_n_per_m, 0.0, 1e15, of + " stiffness_n_per_m");
    const double typical = ei_ / (largest_ * largest_ * largest_);
    ModelParameter p;
    p.name = "coupling_" + name, p.unit = "N/m", p.place = name;
    p.role = coupling.stiffness_n_per_m > 0.0 ? Role::kSpring : Role::kCoupling;
    p.value = coupling.stiffness_n_per_m, p.high = 1e3 * std::max(typical, coupling.stiffness_n_per_m);
    p.scale = coupling.stiffness_n_per_m > 0.0 ? coupling.stiffness_n_per_m : typical;
    p.prior_sigma = frame_.spring_prior * coupling.stiffness_n_per_m;
    mesh_.add_link(from, to, mesh_.add_parameter(std::move(p)));
  }
  // One ratio for all members without shear_n: E over kappa G, so that a section's shear stiffness is E A over it.
  void add_shear() {
    constexpr double kUsual = 3.0;  // steel, kappa 0.85
    if (std::all_of(frame_.members.begin(), frame_.members.end(), [](const auto& m) { return m.shear_n.has_value(); }))
      return;
    ModelParameter p = shear_parameter("1", kUsual);
    p.name = "shear_ratio";
    const std::size_t parameter = mesh_.add_parameter(std::move(p));
    for (std::size_t i = 0; i < frame_.members.size(); ++i) {
      if (!frame_.members[i].shear_n)
        mesh_.add_shear(i, frame_.members[i].ea_n, parameter, kRigidFlexibility, shear_functions_for(mesh_.n_bars()));
    }
  }
  void add_rigid_ends(std::size_t i) {
    const Frame2d::Member& member = frame_.members[i];
    const double most = kMostRigidEnd * length_of(member);
    for (const bool is_last : {false, true}) {
      const std::string& at = is_last ? member.to : member.from;
      mesh_.add_rigid_end(i, is_last,
                          mesh_.add_parameter(rigid_end_parameter("rigid_end_" + member.name + "_" + at,
                                                                  member.name + " at " + at, most)),
                          most);
    }
  }

  const Frame2d& frame_;
  LineMesh mesh_;
  std::map<std::string, std::size_t> nodes_, parts_;
  double largest_ = 0.0, ei_ = 0.0, total_kg_ = 0.0;
};

}  // namespace

std::unique_ptr<StructuralModel> make_frame2d(const Frame2d& frame, std::vector<Sight> sights) {
  return std::make_unique<AffineModel>(Frame2dBuilder(frame).build(std::move(sights)));
}

}  // namespace core::structure
