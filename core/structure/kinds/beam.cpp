#include "core/structure/kinds/beam.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "core/structure/kinds/declared_value.h"

namespace core::structure {
namespace {

constexpr std::size_t kMostBeamParts = 60;

void validate(const Beam& beam) {
  if (beam.spans.empty() || beam.supports.size() != beam.spans.size() + 1)
    refuse_declaration("supports: ", beam.supports.size(), " given for ", beam.spans.size(),
                       " spans; give one for each end of a span, ", beam.spans.size() + 1);
  std::size_t parts = 0;
  for (const Beam::Span& span : beam.spans) {
    require_value(span.length_m, 1e-3, 1e5, "length_m");
    require_value(span.ei_nm2, 1e-9, 1e18, "ei_nm2");
    require_value(span.mass_per_m_kg, 1e-9, 1e9, "mass_per_m_kg");
    require_value(static_cast<double>(span.parts), 1, kMostBeamParts, "parts");
    parts += span.parts;
  }
  if (parts > kMostBeamParts)
    refuse_declaration("parts: ", parts, " in all are refused: allowed 1 .. ", kMostBeamParts);
  require_value(beam.axial_n, -1e15, 1e15, "axial_n");
  if (beam.shear_n) require_value(*beam.shear_n, 1e-6, 1e18, "shear_n");
  require_value(beam.rotary_per_m_kgm, 0.0, 1e12, "rotary_per_m_kgm");
}

class BeamBuilder {
 public:
  explicit BeamBuilder(const Beam& beam) : beam_(beam), mesh_(false, bubbles_for(n_parts(beam))) {
    for (const Beam::Span& span : beam.spans) {
      length_ += span.length_m;
      total_kg_ += span.length_m * span.mass_per_m_kg;
      ei_ = std::max(ei_, span.ei_nm2);
    }
  }

  AffineMatrices build(std::vector<Sight> sights) {
    add_node(0.0);
    add_support(0);
    for (std::size_t i = 0; i < beam_.spans.size(); ++i) add_span(i);
    add_axial();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      add_possible_mass(mesh_, nodes_[i], total_kg_, "mass_" + std::to_string(i), place_text(at_[i]));
    for (const Beam::Mass& mass : beam_.masses) add_mass(mass);
    add_shear();
    add_rigid_ends();
    mesh_.set_length(mesh_.add_parameter(length_parameter()));
    return mesh_.build("beam", std::move(sights), 0.5 * length_);
  }

 private:
  static std::size_t n_parts(const Beam& beam) {
    return std::accumulate(beam.spans.begin(), beam.spans.end(), std::size_t{0},
                           [](std::size_t n, const Beam::Span& span) { return n + span.parts; });
  }
  void add_node(double x) {
    nodes_.push_back(mesh_.add_node(x, 0.0));
    at_.push_back(x);
    mesh_.fix(nodes_.back(), Motion::kX);
  }
  void add_support(std::size_t i) {
    const Beam::Support& support = beam_.supports[i];
    const std::string name = "support_" + std::to_string(i + 1), place = place_text(at_.back());
    const double l = length_;
    connect(mesh_, nodes_.back(), Motion::kZ, support.displacement, ei_ / (l * l * l), name + "_displacement", place,
            beam_.spring_prior);
    connect(mesh_, nodes_.back(), Motion::kTurn, support.rotation, ei_ / l, name + "_rotation", place,
            beam_.spring_prior);
  }
  void add_span(std::size_t i) {
    const Beam::Span& span = beam_.spans[i];
    const double step = span.length_m / static_cast<double>(span.parts);
    Bar bar;
    bar.ei = span.ei_nm2, bar.mass_per_m = span.mass_per_m_kg;
    bar.shear = beam_.shear_n, bar.rotary_per_m = beam_.rotary_per_m_kgm;
    for (std::size_t k = 0; k < span.parts; ++k) {
      const double from = at_.back();
      add_node(from + step);
      ModelParameter p;
      p.name = "stiffness_" + std::to_string(mesh_.n_bars() + 1), p.unit = "1";
      p.role = Role::kPartStiffness;
      p.value = 1.0, p.low = 0.01, p.high = 50.0, p.scale = 0.2, p.prior_sigma = beam_.part_prior;
      p.place = place_text(from) + " .. " + place_text(from + step);
      mesh_.add_bar(nodes_[nodes_.size() - 2], nodes_.back(), bar, mesh_.add_parameter(std::move(p)));
    }
    add_support(i + 1);
  }
  void add_axial() {
    ModelParameter p;
    p.name = "axial_force", p.unit = "N";
    p.role = Role::kAxialForce;
    const double euler = ei_ * 9.87 / (length_ * length_);
    p.value = beam_.axial_n, p.scale = 0.1 * euler;
    p.low = std::min(beam_.axial_n, 0.0) - 10.0 * euler, p.high = std::max(beam_.axial_n, 0.0) + 1000.0 * euler;
    const std::size_t parameter = mesh_.add_parameter(std::move(p));
    for (std::size_t i = 0; i < mesh_.n_bars(); ++i)
      mesh_.add_tension(
          i, [](double) { return 1.0; }, parameter);
  }
  // In series with bending; with shear_n it is declared.
  void add_shear() {
    if (beam_.shear_n) return;
    double longest = 0.0;
    for (const Beam::Span& span : beam_.spans) longest = std::max(longest, span.length_m);
    const double scale = 0.01 * longest * longest / ei_;
    const std::size_t parameter = mesh_.add_parameter(shear_parameter("1/N", scale));
    for (std::size_t i = 0; i < mesh_.n_bars(); ++i)
      mesh_.add_shear(i, 1.0, parameter, kRigidFlexibility * scale, shear_functions_for(mesh_.n_bars()));
  }
  // Of the parts next to the supports.
  void add_rigid_ends() {
    std::size_t bar = 0;
    for (std::size_t i = 0; i < beam_.spans.size(); ++i) {
      const Beam::Span& span = beam_.spans[i];
      const double most = kMostRigidEnd * span.length_m / static_cast<double>(span.parts);
      const std::string name = "rigid_end_" + std::to_string(i + 1);
      mesh_.add_rigid_end(bar, false,
                          mesh_.add_parameter(rigid_end_parameter(name + "_first", place_text(at_[bar]), most)), most);
      bar += span.parts;
      mesh_.add_rigid_end(bar - 1, true,
                          mesh_.add_parameter(rigid_end_parameter(name + "_last", place_text(at_[bar]), most)), most);
    }
  }
  void add_mass(const Beam::Mass& mass) {
    require_value(mass.at_m, 0.0, length_, "masses at_m");
    require_value(mass.kg, 0.0, 1e12, "masses kg");
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      if (std::abs(at_[i] - mass.at_m) < std::abs(at_[nearest] - mass.at_m)) nearest = i;
    }
    mesh_.add_mass(nodes_[nearest], mass.kg, std::nullopt);
  }

  const Beam& beam_;
  LineMesh mesh_;
  std::vector<std::size_t> nodes_;
  std::vector<double> at_;
  double length_ = 0.0, total_kg_ = 0.0, ei_ = 0.0;
};

}  // namespace

std::unique_ptr<StructuralModel> make_beam(const Beam& beam, std::vector<Sight> sights) {
  validate(beam);
  return std::make_unique<AffineModel>(BeamBuilder(beam).build(std::move(sights)));
}

}  // namespace core::structure
