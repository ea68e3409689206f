#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/closure/response/free_decay_fit.h"
#include "core/closure/response/response_model.h"

namespace core::closure {

// Free decays, modelled as a linear mode, release by release. Held out: one release at a time; poles, shapes and
// effects are fitted to the others, and only its own amplitude, phase and equilibrium (which no model predicts) are
// fitted to it. Unit: that of the record.
class FreeDecayModel final : public ResponseModel {
 public:
  static constexpr double kMaterial = 0.1;     // of the held-out squares
  static constexpr double kTwinMac = 0.9;      // a further mode with the shape of the first is rejected ...
  static constexpr double kMostDamping = 0.3;  // ... and so is an overdamped one

  explicit FreeDecayModel(FreeDecays decays) : decays_(std::move(decays)) {}

  [[nodiscard]] std::string unit() const override { return decays_.unit; }
  [[nodiscard]] std::vector<std::string> effects() const override;
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] double material_share(const std::string& /*effect*/) const override { return kMaterial; }
  [[nodiscard]] ResponseFit fit(const std::vector<std::string>& effects) const override;
  [[nodiscard]] std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>& effects,
                                                         std::uint64_t seed) const override;

  [[nodiscard]] const FreeDecays& decays() const noexcept { return decays_; }

 private:
  using State = FreeDecayFit::State;
  // Cached: every set of effects is requested several times, and starts from the set without its last effect.
  [[nodiscard]] const State& state_of(const std::vector<std::string>& effects) const;
  [[nodiscard]] ResponseFit describe(const FreeDecayFit& fit, const State& state,
                                     const std::vector<State>& without) const;

  FreeDecays decays_;
  bool made_up_ = false;  // surrogate: starts at the state from which it was generated, with few iterations
  mutable std::map<std::vector<std::string>, State> states_;
};

}  // namespace core::closure
