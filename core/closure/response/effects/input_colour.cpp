#include "core/closure/response/effects/catalogue.h"
#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

constexpr double kMostWhite = 0.3;  // largest share of its variance that is predictable from its past

// The excitation is not white: its peaks are mistaken for modes unless the input is measured and used.
class InputColour final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "input_colour"; }
  [[nodiscard]] bool adds_input() const override { return true; }
  [[nodiscard]] ParameterValue describe(double value) const override {
    return {"predictable_share_of_input", "1", value, {}};
  }
  [[nodiscard]] std::string immaterial(double value) const override {
    return value >= kMostWhite ? ""
                               : "the input is nearly white: only " + number(value) + " of it follows from its past";
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_input_colour() { return std::make_unique<InputColour>(); }

}  // namespace core::closure
