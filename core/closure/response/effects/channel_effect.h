#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/response/channel_predictor.h"
#include "core/types/closure_result.h"

namespace core::closure {

// Inputs of an effect: the record, its channels relative to the base, and the result of a linear predictor of these.
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
    double count = 0.0, sigma = 0.0;  // samples that were put in, taken out or blanked, and its standard deviation
    std::string words = {};            // what was done; may be empty
  };

  ChannelEffect() = default;
  ChannelEffect(const ChannelEffect&) = delete;
  ChannelEffect& operator=(const ChannelEffect&) = delete;
  virtual ~ChannelEffect() = default;

  [[nodiscard]] virtual std::string name() const = 0;

  [[nodiscard]] virtual bool corrects() const { return false; }
  [[nodiscard]] virtual Corrected corrected(const ChannelContext& context) const { return {context.record}; }

  // Its evidence are frames at other times than stated: not sought where time stamps tell them.
  [[nodiscard]] virtual bool is_of_the_clock() const { return false; }

  [[nodiscard]] virtual bool has_course() const { return false; }
  [[nodiscard]] virtual Eigen::VectorXd course(const ChannelContext& /*context*/) const { return {}; }

  // The course where the structure is as it is looked for: in the mean (0), at rest, ...
  [[nodiscard]] virtual double course_at_rest() const { return 0.0; }

  // How the record is repaired, in words; "" = it is not.
  [[nodiscard]] virtual std::string repair() const { return {}; }

  [[nodiscard]] virtual bool jitters() const { return false; }
  [[nodiscard]] virtual bool adds_input() const { return false; }

  // Of its number: places per record, relative change of frequency per unit of the course, s of jitter.
  [[nodiscard]] virtual ParameterValue describe(double value) const = 0;
  [[nodiscard]] virtual std::string immaterial(double /*value*/) const { return {}; }
};

}  // namespace core::closure
