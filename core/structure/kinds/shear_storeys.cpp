#include "core/structure/kinds/shear_storeys.h"

#include <cmath>
#include <utility>

#include "core/structure/kinds/declared_value.h"
#include "core/types/constants.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

class ShearStoreys final : public StructuralModel {
 public:
  ShearStoreys(ShearFrame frame, std::vector<Sight> sights, double part_prior)
      : frame_(std::move(frame)), sights_(std::move(sights)) {
    double mean = 0.0;
    for (const double m : frame_.mass) mean += m / static_cast<double>(n());
    for (std::size_t i = 0; i < n(); ++i) add("stiffness", i, Role::kPartStiffness, 1.0, 0.01, 50.0, 0.2, part_prior);
    for (std::size_t i = 0; i < n(); ++i) add("mass", i, Role::kAddedMass, 0.0, 0.0, 20.0 * mean, 0.2 * mean, 0.0);
    parameters_.push_back({"joint_flexibility", "1", Role::kOther, frame_.joint_flexibility, 0.0, 100.0, 0.1, 0.0, {}});
    parameters_.push_back(
        {"rocking_flexibility", "1", Role::kSupportTurning, frame_.rocking_flexibility, 0.0, 10.0, 0.02, 0.0, "foot"});
    parameters_.push_back(
        {"bending_flexibility", "1", Role::kOther, frame_.bending_flexibility, 0.0, 10.0, 0.01, 0.0, {}});
    parameters_.push_back({"gravity_over_height",
                           "1/s^2",
                           Role::kGravity,
                           frame_.gravity_over_height_per_s2,
                           0.0,
                           1e3 * kStandardGravity_m_s2,
                           10.0,
                           0.0,
                           {}});
    for (const Sight& sight : sights_) {
      const double floor = sight.at_m.z();
      require_value(floor, 1.0, static_cast<double>(n()), "floor of `" + sight.channel + "`");
    }
  }
  [[nodiscard]] std::string_view kind() const noexcept override { return "shear_frame"; }
  [[nodiscard]] const std::vector<ModelParameter>& parameters() const noexcept override { return parameters_; }
  [[nodiscard]] const std::vector<Sight>& sights() const noexcept override { return sights_; }

  // Storeys one above the other, of unit height.
  [[nodiscard]] std::vector<DrawnItem> drawing() const override {
    std::vector<DrawnItem> out;
    for (std::size_t i = 0; i < n(); ++i) {
      const Eigen::Vector2d floor(0.0, static_cast<double>(i) + 1.0);
      out.push_back({i, floor - Eigen::Vector2d::UnitY(), floor});
      out.push_back({n() + i, floor, floor});
    }
    out.push_back({2 * n() + 1, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()});
    return out;
  }

  [[nodiscard]] std::optional<ModelModes> modes(const VectorXd& values, std::size_t n_modes,
                                                const std::vector<std::size_t>& derivatives) const override {
    auto out = at(values, n_modes);
    if (!out || derivatives.empty()) return out;
    out->d_frequency_hz.resize(out->frequency_hz.size(), static_cast<Index>(derivatives.size()));
    for (std::size_t d = 0; d < derivatives.size(); ++d) {
      const auto i = static_cast<Index>(derivatives[d]);
      const ModelParameter& p = parameters_[derivatives[d]];
      const double step = 1e-4 * p.scale;
      VectorXd up = values, down = values;
      up(i) += step;
      down(i) = std::max(values(i) - step, p.low);
      const auto high = at(up, n_modes), low = at(down, n_modes);
      if (!high || !low) return std::nullopt;
      const double width = up(i) - down(i);
      out->d_frequency_hz.col(static_cast<Index>(d)) = (high->frequency_hz - low->frequency_hz) / width;
      Eigen::MatrixXd slope(out->shapes.rows(), out->shapes.cols());
      for (Index r = 0; r < slope.cols(); ++r) {
        const auto aligned = [&](const Eigen::MatrixXd& shapes) {
          const double sign = shapes.col(r).dot(out->shapes.col(r)) < 0.0 ? -1.0 : 1.0;
          return VectorXd(sign * shapes.col(r));
        };
        slope.col(r) = (aligned(high->shapes) - aligned(low->shapes)) / width;
      }
      out->d_shapes.push_back(std::move(slope));
    }
    return out;
  }

 private:
  [[nodiscard]] std::size_t n() const noexcept { return frame_.mass.size(); }
  void add(const char* what, std::size_t i, Role role, double value, double low, double high, double scale,
           double prior) {
    const std::string number = std::to_string(i + 1);
    parameters_.push_back({std::string(what) + "_" + number, role == Role::kAddedMass ? "relative mass" : "1", role,
                           value, low, high, scale, prior, (role == Role::kAddedMass ? "floor " : "storey ") + number});
  }
  [[nodiscard]] std::optional<ModelModes> at(const VectorXd& values, std::size_t n_modes) const {
    ShearFrame frame = frame_;
    const auto count = static_cast<Index>(n());
    for (Index i = 0; i < count; ++i) {
      frame.stiffness_per_s2[static_cast<std::size_t>(i)] *= values(i);
      frame.mass[static_cast<std::size_t>(i)] += values(count + i);
    }
    frame.joint_flexibility = values(2 * count), frame.rocking_flexibility = values(2 * count + 1);
    frame.bending_flexibility = values(2 * count + 2), frame.gravity_over_height_per_s2 = values(2 * count + 3);
    const auto modes = frame_modes(frame, true);
    if (!modes) return std::nullopt;
    const Index kept = std::min(static_cast<Index>(n_modes), count);
    ModelModes out;
    out.frequency_hz = modes->frequency_hz.head(kept);
    out.shapes.resize(static_cast<Index>(sights_.size()), kept);
    for (Index r = 0; r < kept; ++r) {
      double modal_mass = 0.0;
      for (Index i = 0; i < count; ++i)
        modal_mass += frame.mass[static_cast<std::size_t>(i)] * modes->shapes(i, r) * modes->shapes(i, r);
      for (Index s = 0; s < out.shapes.rows(); ++s) {
        const Sight& sight = sights_[static_cast<std::size_t>(s)];
        const auto floor = static_cast<Index>(std::lround(sight.at_m.z())) - 1;
        out.shapes(s, r) = sight.direction.x() * modes->shapes(floor, r) / std::sqrt(modal_mass);
      }
    }
    return out;
  }

  ShearFrame frame_;
  std::vector<Sight> sights_;
  std::vector<ModelParameter> parameters_;
};

}  // namespace

std::unique_ptr<StructuralModel> make_shear_storeys(const ShearFrame& frame, std::vector<Sight> sights,
                                                    double part_prior) {
  return std::make_unique<ShearStoreys>(frame, std::move(sights), part_prior);
}

}  // namespace core::structure
