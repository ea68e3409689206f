#include "core/closure/observation/adoption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/closure/observation/effects/catalogue.h"

namespace core::closure {
namespace {

template <class List>
auto find(List& list, const EffectId& id) {
  return std::find_if(list.begin(), list.end(), [&](const auto& e) { return e.id == id; });
}

// nullptr: the effect is not corrected in flight.
const InFlightCorrection* in_flight(const EffectId& id) {
  const ObservationEffect* effect = observation_effect(id);
  return effect != nullptr ? effect->in_flight() : nullptr;
}

// Compares the strongest parameter only: the others may be close to zero.
bool same(const std::vector<ParameterValue>& a, const std::vector<ParameterValue>& b) {
  if (a.size() != b.size() || a.empty()) return false;
  const auto strongest = static_cast<std::size_t>(
      std::max_element(a.begin(), a.end(),
                       [](const auto& x, const auto& y) { return std::abs(x.value) < std::abs(y.value); }) -
      a.begin());
  const ParameterValue &x = a[strongest], &y = b[strongest];
  const double sigma = std::hypot(x.sigma.value_or(0.0), y.sigma.value_or(0.0));
  return std::abs(x.value - y.value) <=
         std::max(Adoption::kSameSigmas * sigma, Adoption::kSameShare * std::abs(x.value));
}

std::string error_text(double before, double after, const std::string& unit) {
  std::array<char, 80> text{};
  (void)std::snprintf(text.data(), text.size(), "held-out error %.4f -> %.4f %s", before, after, unit.c_str());
  return text.data();
}

std::string numbers_text(const std::string& effect, const std::vector<ParameterValue>& parameters) {
  ClosureStep step;
  step.effect = effect, step.parameters = parameters;
  return effect + ": " + parameters_text(step);
}

}  // namespace

std::vector<Adoption::Finding> Adoption::findings(const ClosureResult& result) {
  std::vector<Finding> out;
  for (const ClosureStep& step : result.steps) {
    if (step.kind == EffectKind::kNamed && in_flight(step.id) != nullptr && step.rivals.empty())
      out.push_back({step.id, step.effect, step.parameters, step.heldout_before, step.heldout_after});
  }
  return out;
}

void Adoption::update_in_all(const std::vector<Finding>& now) {
  if (!has_reports_) {
    for (const Finding& finding : now) in_all_.push_back(finding.id);
  }
  std::erase_if(in_all_, [&](const EffectId& id) { return find(now, id) == now.end(); });
  has_reports_ = true;
}

std::vector<std::string> Adoption::update(const ClosureReport& report, std::uint64_t from_sequence) {
  std::vector<std::string> changes;
  changes_delays_ = false;
  if (!report.refused.empty()) return changes;
  const std::string from = "from frame " + std::to_string(from_sequence) + " on ";
  std::vector<Finding> now = findings(report.result);
  update_in_all(now);
  for (const Finding& finding : now) {
    const auto before = find(last_, finding.id);
    if (before == last_.end() || !same(finding.parameters, before->parameters)) continue;
    const auto known = find(in_force_, finding.id);
    if (known != in_force_.end() && same(finding.parameters, known->parameters)) continue;
    changes_delays_ = changes_delays_ || (in_flight(finding.id)->changes_row_delays() &&
                                          std::find(in_all_.begin(), in_all_.end(), finding.id) == in_all_.end());
    const char* what = known == in_force_.end() ? "taken out, " : "taken out with new numbers, ";
    changes.push_back(from + what + numbers_text(finding.effect, finding.parameters) + "; " +
                      error_text(finding.heldout_before, finding.heldout_after, report.result.unit));
    if (known != in_force_.end())
      *known = {finding.id, finding.effect, finding.parameters, from_sequence};
    else
      in_force_.push_back({finding.id, finding.effect, finding.parameters, from_sequence});
  }
  for (auto e = in_force_.begin(); e != in_force_.end();) {
    if (find(now, e->id) != now.end() || report.first_sequence < e->from_sequence) {
      ++e;
      continue;
    }
    changes.push_back(from + "withdrawn, " + e->effect + ": frames " + std::to_string(report.first_sequence) + " to " +
                      std::to_string(report.last_sequence) + " no longer show it");
    changes_delays_ = changes_delays_ || in_flight(e->id)->changes_row_delays();
    e = in_force_.erase(e);
  }
  last_ = std::move(now);
  return changes;
}

std::vector<std::string> Adoption::words() const {
  std::vector<std::string> out;
  for (const EffectInForce& e : in_force_)
    out.push_back(numbers_text(e.effect, e.parameters) + ", from frame " + std::to_string(e.from_sequence) + " on");
  return out;
}

RunCorrection Adoption::correction(const CameraModel& camera) const {
  RunCorrection out;
  for (const EffectInForce& e : in_force_) in_flight(e.id)->add_to(out, e.parameters, camera);
  return out;
}

}  // namespace core::closure
