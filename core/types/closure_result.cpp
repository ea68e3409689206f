#include "core/types/closure_result.h"

#include <array>
#include <cstdio>

namespace core::closure {

namespace {

using Number = std::array<char, 64>;

}  // namespace

std::string parameters_text(const ClosureStep& step) {
  std::string out;
  for (const ParameterValue& p : step.parameters) {
    Number value{}, sigma{};
    std::snprintf(value.data(), value.size(), " = %.4g", p.value);
    if (p.sigma) std::snprintf(sigma.data(), sigma.size(), " +- %.2g", *p.sigma);
    out += (out.empty() ? "" : ", ") + p.name + value.data();
    out += p.sigma ? sigma.data() : " (at a bound, or not fixed by the data)";
    if (p.unit != "1") out += " " + p.unit;
  }
  return out.empty() ? "nothing fitted" : out;
}

std::string noise_text(const ClosureResult& result) {
  std::string out;
  for (const ParameterValue& p : result.noise) {
    if (p.value == 0.0) continue;
    Number value{};
    std::snprintf(value.data(), value.size(), " %.3g", p.value);
    out += (out.empty() ? "" : ", ") + p.name + value.data();
    if (p.unit != "1") out += " " + p.unit;
  }
  if (!out.empty() && !result.noise_advice.empty()) out += "; " + result.noise_advice;
  return out;
}

}  // namespace core::closure
