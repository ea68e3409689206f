#include <cmath>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/constant_effect.h"

namespace core::closure {
namespace {

constexpr double kLeastMotion = 1e-9;  // smallest rms motion along the rows, in sigmas

// Correction of the declared readout time; the model itself uses it (PointMotionModel::solve).
class ReadoutTime final : public ConstantEffect, private InFlightCorrection {
 public:
  [[nodiscard]] EffectId id() const override { return {"readout_time"}; }
  [[nodiscard]] std::string name() const override { return "readout time"; }
  [[nodiscard]] std::vector<Parameter> constants() const override { return {{"added readout"}}; }
  [[nodiscard]] std::string unit() const override { return "frames"; }
  [[nodiscard]] double most() const override { return 1.5; }
  [[nodiscard]] std::vector<Eigen::MatrixXd> derivatives(const Eigen::VectorXd& /*values*/,
                                                         const FitView& fit) const override {
    return {fit.model.left_at_common_instants(fit.model.readout_field())};
  }
  [[nodiscard]] double moves_px(const Eigen::VectorXd& values, const FitView& fit) const override {
    return rms_about_means(values(0) * fit.model.readout_field());
  }
  [[nodiscard]] double added_readout_frames(const Eigen::VectorXd& values) const override { return values(0); }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& fit, bool /*is_adopted*/) const override {
    if (fit.model.readout_field().norm() > kLeastMotion * std::sqrt(fit.held_out.n_values())) return std::nullopt;
    return NotObservable{name(), "no motion across the lines of the sensor",
                         "film an object that moves over more rows"};
  }

  [[nodiscard]] const InFlightCorrection* in_flight() const override { return this; }

 private:
  void add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
              const CameraModel& /*camera*/) const override {
    if (!parameters.empty()) correction.added_readout = parameters.front();
  }
  [[nodiscard]] bool changes_row_delays() const override { return true; }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_readout_time() { return std::make_unique<ReadoutTime>(); }

}  // namespace core::closure
