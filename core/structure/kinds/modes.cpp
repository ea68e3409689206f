#include "core/structure/kinds/modes.h"

#include <algorithm>
#include <utility>

#include "core/structure/kinds/declared_value.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

class TabulatedModes final : public StructuralModel {
 public:
  explicit TabulatedModes(ModeTable table) : table_(std::move(table)) {
    for (const std::string& name : table_.parameters) {
      ModelParameter p;
      p.name = name, p.unit = "1", p.role = Role::kPartStiffness, p.place = name;
      p.value = 1.0, p.low = 0.5, p.high = 2.0, p.scale = 0.1, p.prior_sigma = table_.prior;
      parameters_.push_back(std::move(p));
    }
    for (const std::string& channel : table_.channels) sights_.push_back({channel, {}, Eigen::Vector3d::UnitX()});
  }
  [[nodiscard]] std::string_view kind() const noexcept override { return "modes"; }
  [[nodiscard]] const std::vector<ModelParameter>& parameters() const noexcept override { return parameters_; }
  [[nodiscard]] const std::vector<Sight>& sights() const noexcept override { return sights_; }
  [[nodiscard]] std::optional<ModelModes> modes(const VectorXd& values, std::size_t n_modes,
                                                const std::vector<std::size_t>& derivatives) const override {
    const auto n = static_cast<Index>(std::min(n_modes, table_.modes.size()));
    const auto n_sights = static_cast<Index>(sights_.size());
    ModelModes out;
    out.frequency_hz.resize(n);
    out.shapes = Eigen::MatrixXd::Zero(n_sights, n);
    out.d_frequency_hz = Eigen::MatrixXd::Zero(n, static_cast<Index>(derivatives.size()));
    out.d_shapes.assign(derivatives.size(), Eigen::MatrixXd::Zero(n_sights, n));
    for (Index r = 0; r < n; ++r) {
      const ModeTable::Mode& mode = table_.modes[static_cast<std::size_t>(r)];
      double change = 1.0;
      for (std::size_t i = 0; i < mode.sensitivity.size(); ++i)
        change += mode.sensitivity[i] * (values(static_cast<Index>(i)) - 1.0);
      if (!(change > 0.0)) return std::nullopt;
      out.frequency_hz(r) = mode.frequency_hz * change;
      if (!mode.shape.empty()) out.shapes.col(r) = Eigen::Map<const VectorXd>(mode.shape.data(), n_sights);
      for (std::size_t d = 0; d < derivatives.size(); ++d)
        out.d_frequency_hz(r, static_cast<Index>(d)) = mode.frequency_hz * mode.sensitivity[derivatives[d]];
    }
    return out;
  }

 private:
  ModeTable table_;
  std::vector<ModelParameter> parameters_;
  std::vector<Sight> sights_;
};

}  // namespace

std::unique_ptr<StructuralModel> make_modes(const ModeTable& table) {
  double last = 0.0;
  for (std::size_t r = 0; r < table.modes.size(); ++r) {
    const ModeTable::Mode& mode = table.modes[r];
    const std::string what = "mode " + std::to_string(r + 1);
    require_value(mode.frequency_hz, 1e-6, 1e9, what + " frequency_hz");
    if (!(mode.frequency_hz >= last)) refuse_declaration(what, ": modes stand in ascending order of frequency");
    last = mode.frequency_hz;
    if (!mode.shape.empty() && mode.shape.size() != table.channels.size())
      refuse_declaration(what, " shape: ", mode.shape.size(), " components for ", table.channels.size(), " channels");
    if (mode.sensitivity.size() != table.parameters.size())
      refuse_declaration(what, " sensitivity: ", mode.sensitivity.size(), " values for ", table.parameters.size(),
                         " parameters");
  }
  if (table.modes.empty()) refuse_declaration("modes: none given; give at least one");
  return std::make_unique<TabulatedModes>(table);
}

}  // namespace core::structure
