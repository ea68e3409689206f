#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/response/channel_predictor.h"
#include "core/types/closure_result.h"

namespace core::closure {

// Inputs of an effect: the record, its channels relative to the base, and a linear predictor of these.
struct ChannelContext {
  const ChannelRecord& record;
  const ChannelRecord& relative;
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
    double count = 0.0, sigma = 0.0;  // samples inserted, removed or masked; sigma of that number
    std::string words = {};           // description of the correction; may be empty
  };

  ChannelEffect() = default;
  ChannelEffect(const ChannelEffect&) = delete;
  ChannelEffect& operator=(const ChannelEffect&) = delete;
  virtual ~ChannelEffect() = default;

  [[nodiscard]] virtual std::string name() const = 0;

  [[nodiscard]] virtual bool corrects() const { return false; }
  [[nodiscard]] virtual Corrected corrected(const ChannelContext& context) const { return {context.record}; }

  // True if its evidence is frames at other times than stated: not tested if time stamps give the times.
  [[nodiscard]] virtual bool is_of_the_clock() const { return false; }

  [[nodiscard]] virtual bool has_course() const { return false; }
  [[nodiscard]] virtual Eigen::VectorXd course(const ChannelContext& /*context*/) const { return {}; }

  // Value of the course at which the structure is reported: at the mean (0), at zero amplitude, ...
  [[nodiscard]] virtual double course_at_rest() const { return 0.0; }

  // Description of the repair of the record; "" = it is not repaired.
  [[nodiscard]] virtual std::string repair() const { return {}; }

  [[nodiscard]] virtual bool jitters() const { return false; }
  [[nodiscard]] virtual bool adds_input() const { return false; }

  // Parameter from its value: samples per record, relative change of frequency per unit of the course, s of jitter.
  [[nodiscard]] virtual ParameterValue describe(double value) const = 0;
  [[nodiscard]] virtual std::string immaterial(double /*value*/) const { return {}; }
};

}  // namespace core::closure
