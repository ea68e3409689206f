#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// The place of rest drifts through each decay: a slope per release and channel, which the left-out release fits alike.
class RestDrift final : public DecayEffect {
 public:
  [[nodiscard]] std::string name() const override { return "drift_of_rest"; }
  [[nodiscard]] bool rest_drifts() const override { return true; }
};

}  // namespace

std::unique_ptr<DecayEffect> make_rest_drift() { return std::make_unique<RestDrift>(); }

}  // namespace core::closure
