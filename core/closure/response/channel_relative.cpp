// Motion of the structure itself: channels relative to the measured base, each at its own instants.
#include <array>
#include <cmath>
#include <limits>

#include "core/closure/response/channel_predictor.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

double delay_of(const std::vector<double>& delays, Index column) {
  return static_cast<std::size_t>(column) < delays.size() ? delays[static_cast<std::size_t>(column)] : 0.0;
}

// Cubic through the four nearest samples; next to a gap a line through two, else NaN. `at` in samples.
double interpolated(const Eigen::Ref<const VectorXd>& values, double at) {
  const Index n = values.size(), below = static_cast<Index>(std::floor(at));
  const double x = at - static_cast<double>(below);
  const auto value = [&](Index k) { return k >= 0 && k < n ? values(k) : std::numeric_limits<double>::quiet_NaN(); };
  if (x == 0.0) return value(below);
  const std::array<double, 4> weight{-x * (x - 1.0) * (x - 2.0) / 6.0, (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
                                     -(x + 1.0) * x * (x - 2.0) / 2.0, (x + 1.0) * x * (x - 1.0) / 6.0};
  double sum = 0.0;
  for (Index i = 0; i < 4; ++i) sum += weight[static_cast<std::size_t>(i)] * value(below - 1 + i);
  if (std::isfinite(sum)) return sum;
  return (1.0 - x) * value(below) + x * value(below + 1);
}

}  // namespace

ChannelRecord relative_to_input(const ChannelRecord& record) {
  if (!record.input_alike || record.input.cols() == 0) return record;
  ChannelRecord out = record;
  for (Index c = 0; c < out.value.cols(); ++c) {
    const double later = record.rate_hz * (delay_of(record.delay_s, c) - delay_of(record.input_delay_s, 0));
    for (Index k = 0; k < out.n_samples(); ++k)
      out.value(k, c) -= interpolated(record.input.col(0), static_cast<double>(k) + later);
  }
  return out;
}

}  // namespace core::closure
