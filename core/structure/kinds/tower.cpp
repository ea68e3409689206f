#include "core/structure/kinds/tower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/structure/kinds/declared_value.h"
#include "core/types/constants.h"

namespace core::structure {
namespace {

constexpr std::size_t kMostTowerParts = 60;

void validate(const Tower& tower) {
  require_value(tower.height_m, 1e-3, 1e4, "height_m");
  require_value(tower.ei_nm2, 1e-9, 1e18, "ei_nm2");
  require_value(tower.mass_per_m_kg, 1e-9, 1e9, "mass_per_m_kg");
  require_value(tower.diameter_ratio, 0.02, 5.0, "diameter_ratio");
  require_value(tower.ei_power, 0.0, 6.0, "ei_power");
  require_value(tower.mass_power, 0.0, 6.0, "mass_power");
  require_value(static_cast<double>(tower.parts), 1, kMostTowerParts, "parts");
  require_value(tower.tip_mass_kg, 0.0, 1e12, "tip_mass_kg");
  if (tower.shear_n) require_value(*tower.shear_n, 1e-6, 1e18, "shear_n");
  require_value(tower.rotary_per_m_kgm, 0.0, 1e12, "rotary_per_m_kgm");
  for (const Tower::Guy& guy : tower.guys) {
    require_value(guy.at_m, 1e-9, tower.height_m, "guys at_m");
    require_value(guy.stiffness_n_per_m, 0.0, 1e15, "guys stiffness_n_per_m");
  }
}

class TowerBuilder {
 public:
  explicit TowerBuilder(const Tower& tower) : tower_(tower), mesh_(false, bubbles_for(tower.parts)) {
    const int n = 64;
    const GaussRule rule = gauss_rule(n);
    for (int i = 0; i < n; ++i)
      shaft_kg_ += rule.weight(i) * tower.height_m * tower.mass_per_m_kg * mass_factor(rule.at(i) * tower.height_m);
  }

  AffineMatrices build(std::vector<Sight> sights) {
    add_levels();
    add_bars();
    add_foot();
    for (std::size_t i = 0; i < tower_.guys.size(); ++i) {
      const Tower::Guy& guy = tower_.guys[i];
      connect(mesh_, node_at(guy.at_m), Motion::kX, Connection::spring(guy.stiffness_n_per_m),
              tower_.ei_nm2 / std::pow(tower_.height_m, 3), "guy_" + std::to_string(i + 1), place_text(guy.at_m),
              tower_.spring_prior);
    }
    if (tower_.tip_mass_kg > 0.0) mesh_.add_mass(nodes_.back(), tower_.tip_mass_kg, std::nullopt);
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      add_possible_mass(mesh_, nodes_[i], shaft_kg_ + tower_.tip_mass_kg, "mass_" + std::to_string(i),
                        place_text(at_[i]));
    add_shear();
    mesh_.set_length(mesh_.add_parameter(length_parameter()));
    return mesh_.build("tower", std::move(sights), 0.5 * tower_.height_m);
  }

 private:
  [[nodiscard]] double diameter(double z) const { return 1.0 + (tower_.diameter_ratio - 1.0) * z / tower_.height_m; }
  [[nodiscard]] double mass_factor(double z) const { return std::pow(diameter(z), tower_.mass_power); }
  [[nodiscard]] double stiffness_factor(double z) const { return std::pow(diameter(z), tower_.ei_power); }
  [[nodiscard]] std::size_t node_at(double z) const {
    return nodes_[static_cast<std::size_t>(std::lower_bound(at_.begin(), at_.end(), z - 1e-9 * tower_.height_m) -
                                           at_.begin())];
  }
  // Ends of parts, and heights of guys.
  void add_levels() {
    for (std::size_t i = 0; i <= tower_.parts; ++i)
      at_.push_back(tower_.height_m * static_cast<double>(i) / static_cast<double>(tower_.parts));
    for (const Tower::Guy& guy : tower_.guys) at_.push_back(guy.at_m);
    std::sort(at_.begin(), at_.end());
    at_.erase(std::unique(at_.begin(), at_.end(), [&](double a, double b) { return b - a < 1e-6 * tower_.height_m; }),
              at_.end());
    for (const double z : at_) {
      nodes_.push_back(mesh_.add_node(0.0, z));
      mesh_.fix(nodes_.back(), Motion::kZ);
    }
  }
  std::size_t part_of(double middle) const {
    const double step = tower_.height_m / static_cast<double>(tower_.parts);
    return std::min(static_cast<std::size_t>(middle / step), tower_.parts - 1);
  }
  // Weight of the shaft above z, N.
  [[nodiscard]] double weight_above(double z) const {
    static const GaussRule kRule = gauss_rule(12);
    double kg = 0.0;
    const double rest = tower_.height_m - z;
    for (Eigen::Index i = 0; i < kRule.at.size(); ++i)
      kg += kRule.weight(i) * rest * tower_.mass_per_m_kg * mass_factor(z + rest * kRule.at(i));
    return kStandardGravity_m_s2 * kg;
  }
  void add_bars() {
    std::vector<std::size_t> parts;
    const double step = tower_.height_m / static_cast<double>(tower_.parts);
    for (std::size_t i = 0; i < tower_.parts; ++i) {
      ModelParameter p;
      p.name = "stiffness_" + std::to_string(i + 1), p.unit = "1";
      p.role = Role::kPartStiffness;
      p.value = 1.0, p.low = 0.01, p.high = 50.0, p.scale = 0.2, p.prior_sigma = tower_.part_prior;
      const double low = step * static_cast<double>(i);
      p.place = place_text(low) + " .. " + place_text(low + step);
      parts.push_back(mesh_.add_parameter(std::move(p)));
    }
    ModelParameter weight;
    weight.name = "gravity", weight.unit = "1", weight.role = Role::kGravity;
    weight.value = tower_.gravity ? 1.0 : 0.0;
    weight.high = 100.0, weight.scale = 0.2;
    const std::size_t gravity = mesh_.add_parameter(std::move(weight));
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
      const double low = at_[i], length = at_[i + 1] - at_[i];
      Bar bar;
      bar.ei = tower_.ei_nm2, bar.mass_per_m = tower_.mass_per_m_kg, bar.shear = tower_.shear_n;
      bar.rotary_per_m = tower_.rotary_per_m_kgm;
      if (tower_.diameter_ratio != 1.0) {
        bar.stiffness_along = [this, low, length](double s) { return stiffness_factor(low + s * length); };
        bar.mass_along = [this, low, length](double s) { return mass_factor(low + s * length); };
      }
      const std::size_t number = mesh_.add_bar(nodes_[i], nodes_[i + 1], bar, parts[part_of(low + 0.5 * length)]);
      mesh_.add_tension(
          number, [this, low, length](double s) { return -weight_above(low + s * length); }, gravity, true);
      if (tower_.tip_mass_kg > 0.0) {
        const double tip_n = kStandardGravity_m_s2 * tower_.tip_mass_kg;
        mesh_.add_tension(
            number, [tip_n](double) { return -tip_n; }, gravity);
      }
    }
  }
  // In series with bending, along the height as the mass; with shear_n it is declared.
  void add_shear() {
    if (tower_.shear_n) return;
    const double scale = 0.01 * tower_.height_m * tower_.height_m / tower_.ei_nm2;
    const std::size_t parameter = mesh_.add_parameter(shear_parameter("1/N", scale));
    for (std::size_t i = 0; i < mesh_.n_bars(); ++i)
      mesh_.add_shear(i, 1.0, parameter, kRigidFlexibility * scale, shear_functions_for(mesh_.n_bars()));
  }
  void add_foot() {
    const double h = tower_.height_m;
    connect(mesh_, nodes_.front(), Motion::kX, tower_.foot_displacement, tower_.ei_nm2 / (h * h * h),
            "foot_displacement", "foot", tower_.spring_prior);
    connect(mesh_, nodes_.front(), Motion::kTurn, tower_.foot_rotation, tower_.ei_nm2 / h, "foot_rotation", "foot",
            tower_.spring_prior);
  }

  const Tower& tower_;
  LineMesh mesh_;
  std::vector<std::size_t> nodes_;
  std::vector<double> at_;
  double shaft_kg_ = 0.0;
};

}  // namespace

std::unique_ptr<StructuralModel> make_tower(const Tower& tower, std::vector<Sight> sights) {
  validate(tower);
  return std::make_unique<AffineModel>(TowerBuilder(tower).build(std::move(sights)));
}

}  // namespace core::structure
