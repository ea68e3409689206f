#include <limits>

#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// A picture shown twice: all channels are what they were a sample before, to the last digit. The second is no sample.
class DuplicatedFrames final : public ChannelEffect {
 public:
  [[nodiscard]] std::string name() const override { return "duplicated_frames"; }
  [[nodiscard]] bool corrects() const override { return true; }
  [[nodiscard]] Corrected corrected(const ChannelContext& context) const override {
    Corrected out{context.record, 0};
    const ChannelRecord& record = context.record;
    for (Eigen::Index k = 1; k < record.n_samples(); ++k) {
      const bool same = record.value.row(k).allFinite() && record.value.row(k) == record.value.row(k - 1) &&
                        (record.input.cols() == 0 || record.input.row(k) == record.input.row(k - 1));
      if (!same) continue;
      out.record.value.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
      ++out.n_places;
    }
    return out;
  }
  [[nodiscard]] ParameterValue describe(double value) const override { return {"duplicates", "frames", value, {}}; }
};

}  // namespace

std::unique_ptr<ChannelEffect> make_duplicated_frames() { return std::make_unique<DuplicatedFrames>(); }

}  // namespace core::closure
