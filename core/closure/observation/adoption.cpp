#include "core/closure/observation/adoption.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

namespace core::closure {
namespace {

constexpr const char *kReadout = "readout time", *kRadial = "radial distortion", *kTangential = "tangential distortion",
                     *kLocking = "pixel locking";
constexpr std::array<std::string_view, 4> kConstants{kReadout, kRadial, kTangential, kLocking};

template <class List>
auto find(List& list, const std::string& effect) {
  return std::find_if(list.begin(), list.end(), [&](const auto& e) { return e.effect == effect; });
}

// Of the strongest parameter: the others may be next to nothing.
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
    const bool constant = std::find(kConstants.begin(), kConstants.end(), step.effect) != kConstants.end();
    if (step.kind == EffectKind::kNamed && constant && step.rivals.empty())
      out.push_back({step.effect, step.parameters, step.heldout_before, step.heldout_after});
  }
  return out;
}

std::vector<std::string> Adoption::update(const ClosureReport& report, std::uint64_t from_sequence) {
  std::vector<std::string> changes;
  changes_delays_ = false;
  if (!report.refused.empty()) return changes;
  const std::string from = "from frame " + std::to_string(from_sequence) + " on ";
  std::vector<Finding> now = findings(report.result);
  readout_in_all_ = find(now, kReadout) != now.end() && (!has_reports_ || readout_in_all_);
  has_reports_ = true;
  for (const Finding& finding : now) {
    const auto before = find(last_, finding.effect);
    if (before == last_.end() || !same(finding.parameters, before->parameters)) continue;
    const auto known = find(in_force_, finding.effect);
    if (known != in_force_.end() && same(finding.parameters, known->parameters)) continue;
    changes_delays_ = changes_delays_ || (finding.effect == kReadout && !readout_in_all_);
    const char* what = known == in_force_.end() ? "taken out, " : "taken out with new numbers, ";
    changes.push_back(from + what + numbers_text(finding.effect, finding.parameters) + "; " +
                      error_text(finding.heldout_before, finding.heldout_after, report.result.unit));
    if (known != in_force_.end())
      *known = {finding.effect, finding.parameters, from_sequence};
    else
      in_force_.push_back({finding.effect, finding.parameters, from_sequence});
  }
  for (auto e = in_force_.begin(); e != in_force_.end();) {
    if (find(now, e->effect) != now.end() || report.first_sequence < e->from_sequence) {
      ++e;
      continue;
    }
    changes.push_back(from + "withdrawn, " + e->effect + ": frames " + std::to_string(report.first_sequence) + " to " +
                      std::to_string(report.last_sequence) + " no longer show it");
    changes_delays_ = changes_delays_ || e->effect == kReadout;
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

double Adoption::value(const std::string& effect, std::size_t parameter) const noexcept {
  const auto found = find(in_force_, effect);
  return found != in_force_.end() && parameter < found->parameters.size() ? found->parameters[parameter].value : 0.0;
}

PointCorrection Adoption::places(const CameraModel& camera) const {
  PointCorrection out;
  for (std::size_t i = 0; i < out.locking_px.size(); ++i) out.locking_px[i] = value(kLocking, i);
  const double k1 = value(kRadial, 0), p1 = value(kTangential, 0), p2 = value(kTangential, 1);
  if (k1 != 0.0 || p1 != 0.0 || p2 != 0.0)
    out.lens = {camera.fx, camera.fx, camera.cx, camera.cy, {k1, 0.0, p1, p2}, LensModel::kRadialTangential};
  return out;
}

ParameterValue Adoption::added_readout() const {
  const auto found = find(in_force_, kReadout);
  if (found == in_force_.end() || found->parameters.empty()) return {};
  return found->parameters.front();
}

}  // namespace core::closure
