// ChannelModel: the record as repaired by the adopted effects.
#include <utility>

#include "core/closure/response/channel_model.h"
#include "core/closure/response/channel_retime.h"
#include "core/closure/response/effects/catalogue.h"

namespace core::closure {

using Eigen::VectorXd;

// The record with constant frequencies: if they change along a course, they become those at the zero of the course, by
// retiming the record.
ChannelRecord ChannelModel::corrected(const std::vector<std::string>& effects) const {
  const Prepared& here = prepared(key_of(effects));
  VectorXd factor = VectorXd::Ones(here.record.n_samples());
  bool moves = false;
  for (const std::string& name : effects) {
    const ChannelEffect& effect = channel_effect(name);
    if (!effect.has_course() || !here.predictor.ok) continue;
    const VectorXd course = effect.course({here.record, here.relative, here.scaled, here.predictor});
    const double change = fitted_course(here, name, course).change;
    factor.array() *= (1.0 + change * course.array()) / (1.0 + change * effect.course_at_rest());
    moves = true;
  }
  return moves ? warped(here.record, time_of_factor(factor, here.record.rate_hz)) : here.record;
}

std::vector<std::string> ChannelModel::repairs(const std::vector<std::string>& effects) const {
  const Prepared& here = prepared(key_of(effects));
  std::vector<std::string> out;
  std::size_t place = 0;
  for (const std::string& name : effects) {
    const ChannelEffect& effect = channel_effect(name);
    std::string words = effect.repair();
    if (effect.corrects() && place < here.done.size()) {
      if (const std::string& done = here.done[place++].words; !done.empty()) words += ", " + done;
    }
    out.push_back(std::move(words));
  }
  return out;
}

}  // namespace core::closure
