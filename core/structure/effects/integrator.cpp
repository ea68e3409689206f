#include <cmath>
#include <numbers>
#include <sstream>

#include "core/structure/effects/catalogue.h"

namespace core::structure {
namespace {

// Average-acceleration Newmark integrates an oscillator w as one of w' = (2 / dt) atan(w dt / 2) (Newmark 1959; Chopra,
// Dynamics of Structures, 5.5): frequencies of simulated records are too low, the more the higher they are.
class Integrator : public StructuralEffect {
 public:
  std::string_view name() const override { return "integrator"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame& declared) const override {
    if (declared.dt_s) return {};
    return {{"dt", "s", 0.0, {0.001, 0.02, 0.1}, 0.0, 100.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override {
    if (declared.simulated) return std::nullopt;
    return Obstacle{"the reference was measured: nothing was integrated",
                    "declare `data: simulated` where it came from a program"};
  }
  bool changes_frequencies() const override { return true; }
  double seen_hz(double frequency_hz, std::span<const double> p, const DeclaredFrame& declared) const override {
    const double half = std::numbers::pi * (p.empty() ? declared.dt_s.value_or(0.0) : p[0]);
    return half > 0.0 ? std::atan(frequency_hz * half) / half : frequency_hz;
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    return p.empty() || p[0] > 0.0 ? "" : "it would have to raise frequencies";
  }
  std::string meaning(std::span<const double> p, const DeclaredFrame& declared) const override {
    std::ostringstream text;
    text.precision(4);
    text << "average-acceleration Newmark with a step of " << (p.empty() ? declared.dt_s.value_or(0.0) : p[0]) << " s"
         << (p.empty() ? ", as declared" : "");
    return text.str();
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_integrator() { return std::make_unique<Integrator>(); }

}  // namespace core::structure
