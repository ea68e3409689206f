#include "core/closure/response/effects/catalogue.h"
#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

constexpr double kMaterial_s = 6e-4;  // records without jitter show values up to this

// Samples are taken randomly earlier or later than stated: innovations increase along the velocity.
class TimeStampJitter final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "time_stamp_jitter"; }
  [[nodiscard]] bool jitters() const override { return true; }
  [[nodiscard]] bool is_of_the_clock() const override { return true; }
  [[nodiscard]] ParameterValue describe(double value) const override { return {"rms", "ms", 1e3 * value, {}}; }
  [[nodiscard]] std::string immaterial(double value) const override {
    return value >= kMaterial_s ? "" : "records without jitter show as much: " + number(1e3 * value) + " ms";
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_time_stamp_jitter() { return std::make_unique<TimeStampJitter>(); }

}  // namespace core::closure
