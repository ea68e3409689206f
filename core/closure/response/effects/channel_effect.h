#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/response/channel_predictor.h"
#include "core/types/closure_result.h"

namespace core::closure {

// Inputs of an effect: the record, and the result of a linear predictor.
struct ChannelContext {
  const ChannelRecord& record;
  const ChannelRecord& scaled;
  const ChannelPredictor& predictor;
};

// Departures of a series of channels from a linear structure under white noise. An effect is one of: another set of
// sample times (corrected), a course along which all frequencies change (course), uncertain sample times (jitters), a
// measured input that is not white (adds_input).
class ChannelEffect {
 public:
  struct Corrected {
    ChannelRecord record;
    std::size_t n_places = 0;  // samples that were changed
  };

  ChannelEffect() = default;
  ChannelEffect(const ChannelEffect&) = delete;
  ChannelEffect& operator=(const ChannelEffect&) = delete;
  virtual ~ChannelEffect() = default;

  [[nodiscard]] virtual std::string name() const = 0;

  [[nodiscard]] virtual bool corrects() const { return false; }
  [[nodiscard]] virtual Corrected corrected(const ChannelContext& context) const { return {context.record, 0}; }

  [[nodiscard]] virtual bool has_course() const { return false; }
  [[nodiscard]] virtual Eigen::VectorXd course(const ChannelContext& /*context*/) const { return {}; }

  [[nodiscard]] virtual bool jitters() const { return false; }
  [[nodiscard]] virtual bool adds_input() const { return false; }

  // Of its number: places per record, relative change of frequency per unit of the course, s of jitter.
  [[nodiscard]] virtual ParameterValue describe(double value) const = 0;
  [[nodiscard]] virtual std::string immaterial(double /*value*/) const { return {}; }
};

}  // namespace core::closure
