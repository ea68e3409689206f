#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// A second linear mode with a shape of its own. With the shape of the first mode it is refused: to a linear model an
// amplitude-dependent mode looks like two modes of one shape.
class FurtherMode final : public DecayEffect {
 public:
  [[nodiscard]] std::string name() const override { return "further_mode"; }
  [[nodiscard]] bool adds_mode() const override { return true; }
};

}  // namespace

std::unique_ptr<DecayEffect> make_further_mode() { return std::make_unique<FurtherMode>(); }

}  // namespace core::closure
