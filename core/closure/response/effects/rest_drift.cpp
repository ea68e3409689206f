#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// The equilibrium drifts during each decay: a slope per release and channel, also fitted to the left-out release.
class RestDrift final : public DecayEffect {
 public:
  [[nodiscard]] std::string name() const override { return "drift_of_rest"; }
  [[nodiscard]] bool rest_drifts() const override { return true; }
};

}  // namespace

std::unique_ptr<DecayEffect> make_rest_drift() { return std::make_unique<RestDrift>(); }

}  // namespace core::closure
