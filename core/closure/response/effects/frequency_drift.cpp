#include <cmath>

#include "core/closure/response/effects/catalogue.h"
#include "core/closure/structure_words.h"

namespace core::closure {
namespace {

constexpr double kMaterial = 0.01;  // records without drift show values up to this

// All frequencies change linearly by the same share over the record.
class FrequencyDrift final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "frequency_drift"; }
  [[nodiscard]] bool has_course() const override { return true; }
  [[nodiscard]] Eigen::VectorXd course(const ChannelContext& context) const override {
    return Eigen::VectorXd::LinSpaced(context.record.n_samples(), -0.5, 0.5);
  }
  [[nodiscard]] std::string repair() const override {
    return "put on a time along which the frequencies stay those of the middle of the record";
  }
  [[nodiscard]] ParameterValue describe(double value) const override {
    return {"change_over_record", "%", 100.0 * value, {}};
  }
  [[nodiscard]] std::string immaterial(double value) const override {
    return std::abs(value) >= kMaterial ? "" : "records without drift show as much: " + number(100.0 * value) + " %";
  }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_frequency_drift() { return std::make_unique<FrequencyDrift>(); }

}  // namespace core::closure
