#include "core/types/closure_result.h"

#include <cstdio>

namespace core::closure {

std::string parameters_text(const ClosureStep& step) {
  std::string out;
  for (const ParameterValue& p : step.parameters) {
    char number[64];
    std::snprintf(number, sizeof number, " = %.4g", p.value);
    out += (out.empty() ? "" : ", ") + p.name + number;
    if (p.sigma) {
      std::snprintf(number, sizeof number, " +- %.2g", *p.sigma);
      out += number;
    } else {
      out += " (at a bound, or not fixed by the data)";
    }
    if (p.unit != "1") out += " " + p.unit;
  }
  return out.empty() ? "nothing fitted" : out;
}

std::string noise_text(const ClosureResult& result) {
  std::string out;
  for (const ParameterValue& p : result.noise) {
    if (p.value == 0.0) continue;
    char number[64];
    std::snprintf(number, sizeof number, " %.3g", p.value);
    out += (out.empty() ? "" : ", ") + p.name + number;
    if (p.unit != "1") out += " " + p.unit;
  }
  if (!out.empty() && !result.noise_advice.empty()) out += "; " + result.noise_advice;
  return out;
}

}  // namespace core::closure
