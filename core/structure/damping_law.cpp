#include "core/structure/damping_law.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/structure/frame_fit.h"

namespace core::structure {
namespace {

constexpr double kRefuted = 9.0;  // of chi^2 above the best law: three standard deviations

struct Damped {
  double hz, ratio, sigma;
};

std::vector<Damped> damped_modes(const std::vector<ReferenceMode>& reference) {
  std::vector<Damped> out;
  for (const ReferenceMode& mode : reference) {
    if (mode.damping_ratio && *mode.damping_ratio > 0.0 && mode.damping_sigma > 0.0)
      out.push_back({mode.frequency_hz, *mode.damping_ratio, mode.damping_sigma});
  }
  return out;
}

// Weighted sums of the two columns 1 / f and f, or 1, and the ratios.
double product(const std::vector<Damped>& modes, int power_a, int power_b) {
  double out = 0.0;
  for (const Damped& m : modes) out += std::pow(m.hz, power_a + power_b) / (m.sigma * m.sigma);
  return out;
}
double with_ratio(const std::vector<Damped>& modes, int power) {
  double out = 0.0;
  for (const Damped& m : modes) out += m.ratio * std::pow(m.hz, power) / (m.sigma * m.sigma);
  return out;
}

double predicted(const DampingLawFit& fit, double hz) { return fit.hz / hz + fit.per_hz * hz + fit.ratio; }

void finish(DampingLawFit& fit, const std::vector<Damped>& modes, double n_coefficients) {
  fit.chi2 = 0.0;
  for (const Damped& m : modes) {
    const double off = (predicted(fit, m.hz) - m.ratio) / m.sigma;
    fit.chi2 += off * off;
  }
  fit.degrees_of_freedom = static_cast<double>(modes.size()) - n_coefficients;
}

DampingLawFit one_coefficient(DampingLaw law, const std::vector<Damped>& modes) {
  DampingLawFit out;
  out.law = law;
  const int power = law == DampingLaw::kMassProportional ? -1 : law == DampingLaw::kStiffnessProportional ? 1 : 0;
  const double square = product(modes, power, power);
  const double value = std::max(with_ratio(modes, power) / square, 0.0), sigma = 1.0 / std::sqrt(square);
  if (power == -1) out.hz = value, out.hz_sigma = sigma;
  if (power == 1) out.per_hz = value, out.per_hz_sigma = sigma;
  if (power == 0) out.ratio = value, out.ratio_sigma = sigma;
  finish(out, modes, 1.0);
  return out;
}

DampingLawFit rayleigh(const std::vector<Damped>& modes, const DampingLawFit& mass, const DampingLawFit& stiffness) {
  const double aa = product(modes, -1, -1), bb = product(modes, 1, 1), ab = product(modes, -1, 1);
  const double ra = with_ratio(modes, -1), rb = with_ratio(modes, 1), det = aa * bb - ab * ab;
  DampingLawFit out = mass.chi2 < stiffness.chi2 ? mass : stiffness;  // a coefficient below 0 is left out
  out.law = DampingLaw::kRayleigh;
  out.degrees_of_freedom -= 1.0;
  if (!(det > 1e-9 * aa * bb)) return out;  // all modes at one frequency
  const double a = (bb * ra - ab * rb) / det, b = (aa * rb - ab * ra) / det;
  if (!(a > 0.0 && b > 0.0)) return out;
  out.hz = a, out.hz_sigma = std::sqrt(bb / det), out.per_hz = b, out.per_hz_sigma = std::sqrt(aa / det);
  finish(out, modes, 2.0);
  return out;
}

DampingLawFit fit_of(DampingLaw law, const std::vector<Damped>& modes) {
  if (law != DampingLaw::kRayleigh) return one_coefficient(law, modes);
  return rayleigh(modes, one_coefficient(DampingLaw::kMassProportional, modes),
                  one_coefficient(DampingLaw::kStiffnessProportional, modes));
}

double heldout_percent(DampingLaw law, const std::vector<Damped>& modes) {
  double squares = 0.0;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    std::vector<Damped> others = modes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const double error = predicted(fit_of(law, others), modes[i].hz) / modes[i].ratio - 1.0;
    squares += error * error;
  }
  return 100.0 * std::sqrt(squares / static_cast<double>(modes.size()));
}

std::string coefficient_text(const DampingLawFit& fit) {
  std::ostringstream out;
  out.precision(3);
  const auto add = [&](const char* before, double value, double sigma, const char* after) {
    out << before << '(' << value << " +- " << sigma << ')' << after;
  };
  if (fit.law == DampingLaw::kConstant) {
    add("zeta = ", fit.ratio, fit.ratio_sigma, "");
  } else {
    if (fit.hz_sigma > 0.0) add("zeta = ", fit.hz, fit.hz_sigma, " Hz / f");
    if (fit.per_hz_sigma > 0.0) add(fit.hz_sigma > 0.0 ? " + " : "zeta = ", fit.per_hz, fit.per_hz_sigma, " s f");
  }
  return out.str();
}

}  // namespace

std::string_view name_of(DampingLaw law) noexcept {
  switch (law) {
    case DampingLaw::kMassProportional:
      return "viscous, mass-proportional";
    case DampingLaw::kStiffnessProportional:
      return "viscous, stiffness-proportional";
    case DampingLaw::kRayleigh:
      return "viscous, of mass and stiffness (Rayleigh)";
    default:
      return "constant (hysteretic)";
  }
}

std::vector<DampingLaw> DampingVerdict::possible() const {
  std::vector<DampingLaw> out;
  for (const DampingLawFit& fit : laws) {
    if (fit.is_possible) out.push_back(fit.law);
  }
  return out;
}

DampingVerdict damping_verdict(const std::vector<ReferenceMode>& reference) {
  DampingVerdict out;
  const std::vector<Damped> modes = damped_modes(reference);
  out.n_modes = modes.size();
  if (modes.size() < kLeastDampedModes) return out;
  for (const DampingLaw law : {DampingLaw::kMassProportional, DampingLaw::kStiffnessProportional, DampingLaw::kConstant,
                               DampingLaw::kRayleigh}) {
    out.laws.push_back(fit_of(law, modes));
    out.laws.back().heldout_percent = heldout_percent(law, modes);
  }
  const double least = std::min_element(out.laws.begin(), out.laws.end(), [](const auto& a, const auto& b) {
                         return a.chi2 < b.chi2;
                       })->chi2;
  for (DampingLawFit& fit : out.laws)
    fit.is_possible = fit.chi2 <= chi2_limit(fit.degrees_of_freedom) && fit.chi2 <= least + kRefuted;
  // A part of Rayleigh's law that explains the modes makes the whole needless.
  if (out.laws[0].is_possible || out.laws[1].is_possible) out.laws[3].is_possible = false;
  return out;
}

std::string damping_words(const DampingVerdict& verdict) {
  if (verdict.n_modes == 0) return {};
  std::ostringstream out;
  out.precision(3);
  out << "damping of " << verdict.n_modes << " modes over frequency: ";
  if (verdict.laws.empty()) {
    out << "the mechanism cannot be told from fewer than " << kLeastDampedModes << " modes with a sigma";
    return out.str();
  }
  const std::vector<DampingLaw> left = verdict.possible();
  if (left.empty()) {
    out << "none of these mechanisms";
  } else if (left.size() == 1) {
    out << name_of(left.front());
  } else {
    out << "cannot be told apart, the sigmas leave " << left.size() << " mechanisms";
  }
  for (const DampingLawFit& fit : verdict.laws) {
    out << "\n  " << (fit.is_possible ? "possible  " : "          ") << name_of(fit.law) << ": "
        << coefficient_text(fit) << ", held out " << fit.heldout_percent << " %, chi-square " << fit.chi2 << " with "
        << fit.degrees_of_freedom << " degrees of freedom";
  }
  return out.str();
}

}  // namespace core::structure
