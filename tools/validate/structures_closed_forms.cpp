// Kinds of structural models against closed-form solutions: roots of characteristic equations, in extended precision.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/kinds/shear_storeys.h"
#include "core/structure/kinds/tower.h"
#include "tools/validate/structures.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using namespace core::structure;
using Real = long double;
using Roots = std::vector<Real>;

constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr std::size_t kModes = 8;
constexpr double kLength_m = 24.0, kEi_nm2 = 3.1e7, kKgPerM = 85.0;

// The first roots above zero; step: less than the distance between two.
Roots roots_of(const std::function<Real(Real)>& f, std::size_t n, Real step = 1e-3L) {
  Roots out;
  Real x = step, before = f(x);
  while (out.size() < n) {
    const Real next = f(x + step);
    if ((before < 0.0L) != (next < 0.0L)) {
      Real low = x, high = x + step;
      for (int i = 0; i < 80; ++i) {
        const Real middle = 0.5L * (low + high);
        ((f(middle) < 0.0L) == (before < 0.0L) ? low : high) = middle;
      }
      out.push_back(0.5L * (low + high));
    }
    x += step;
    before = next;
  }
  return out;
}

// Of a beam: lambda is the root for the length.
std::vector<double> beam_hz(const Roots& lambda, double length_m = kLength_m) {
  std::vector<double> out;
  const Real unit = std::sqrt(Real{kEi_nm2} / kKgPerM) / (2.0L * kPi * length_m * length_m);
  for (const Real l : lambda) out.push_back(static_cast<double>(l * l * unit));
  return out;
}

KindError compare(const StructuralModel& model, std::string structure, const std::vector<double>& exact_hz) {
  KindError out{std::string(model.kind()), std::move(structure), "closed form", exact_hz.size(), 1e9};
  const auto modes = model.modes(declared_values(model), exact_hz.size(), {});
  if (!modes || modes->frequency_hz.size() != static_cast<Eigen::Index>(exact_hz.size())) return out;
  out.worst = 0.0;
  for (std::size_t r = 0; r < exact_hz.size(); ++r) {
    out.worst = std::max(out.worst, std::abs(modes->frequency_hz(static_cast<Eigen::Index>(r)) / exact_hz[r] - 1.0));
  }
  return out;
}

Beam beam(std::size_t n_spans, std::size_t parts) {
  Beam out;
  out.spans.assign(n_spans, {kLength_m / static_cast<double>(n_spans), kEi_nm2, kKgPerM, parts});
  out.supports.resize(n_spans + 1);
  return out;
}

Tower tower(std::size_t parts) {
  Tower out;
  out.height_m = kLength_m, out.ei_nm2 = kEi_nm2, out.mass_per_m_kg = kKgPerM;
  out.gravity = false, out.parts = parts;
  return out;
}

Roots multiples_of_pi(std::size_t n) {
  Roots out;
  for (std::size_t r = 1; r <= n; ++r) out.push_back(static_cast<Real>(r) * kPi);
  return out;
}

void add_towers(std::vector<KindError>& out) {
  const Roots plain = roots_of([](Real x) { return std::cos(x) + 1.0L / std::cosh(x); }, kModes);
  for (const std::size_t parts : {1UL, 10UL})
    out.push_back(
        compare(*make_tower(tower(parts), {}), fmt::format("uniform cantilever of {} parts", parts), beam_hz(plain)));
  Tower tipped = tower(4);
  constexpr Real kRatio = 0.35L;  // tip mass over that of the shaft
  tipped.tip_mass_kg = static_cast<double>(kRatio) * kLength_m * kKgPerM;
  const Roots heavy = roots_of(
      [](Real x) {
        return 1.0L / std::cosh(x) + std::cos(x) + kRatio * x * (std::cos(x) * std::tanh(x) - std::sin(x));
      },
      kModes);
  out.push_back(compare(*make_tower(tipped, {}), "cantilever with a tip mass", beam_hz(heavy)));
  // Foot on a rotational spring k: x (cos sinh - sin cosh) EI/(k L) + 1 + cos cosh = 0 (Blevins, table 8-1).
  constexpr Real kTurn = 0.2L;  // E I / (k L)
  Tower turning = tower(4);
  turning.foot_rotation = Connection::spring(kEi_nm2 / (static_cast<double>(kTurn) * kLength_m));
  const Roots turned = roots_of(
      [](Real x) { return 1.0L / std::cosh(x) + std::cos(x) + kTurn * x * (std::cos(x) * std::tanh(x) - std::sin(x)); },
      kModes);
  out.push_back(compare(*make_tower(turning, {}), "cantilever on a rotational spring", beam_hz(turned)));
}

// Symmetric (or antisymmetric) motion of two equal spans l on springs: ends k_1, middle k_2, in units of E I / l^3.
// w = a sin + b cos + c e^-x + d e^(x - l) over one span, from the end.
Real two_spans(Real x, Real k_1, Real k_2, bool symmetric) {
  const Real s = std::sin(x), c = std::cos(x), e = std::exp(-x), x3 = x * x * x;
  Eigen::Matrix<Real, 4, 4> m;
  m.row(0) << 0, -1, 1, e;                         // no moment at the end
  m.row(1) << -x3, k_1, k_1 - x3, (x3 + k_1) * e;  // w''' = -k_1 w
  if (symmetric) {
    m.row(2) << c, -s, -e, 1;  // no slope at the middle
    const Real h = 0.5L * k_2;
    m.row(3) << -x3 * c - h * s, x3 * s - h * c, (-x3 - h) * e, x3 - h;  // w''' = k_2 w / 2
  } else {
    m.row(2) << s, c, e, 1;
    m.row(3) << -s, -c, e, 1;
  }
  return m.determinant();
}

void add_beams(std::vector<KindError>& out) {
  for (const std::size_t parts : {1UL, 10UL})
    out.push_back(compare(*make_beam(beam(1, parts), {}), fmt::format("simply supported beam of {} parts", parts),
                          beam_hz(multiples_of_pi(kModes))));
  // Two equal spans: those of one simply supported span, and of one span clamped at the middle.
  Roots two = multiples_of_pi(kModes / 2);
  for (const Real x : roots_of([](Real v) { return std::sin(v) - std::tanh(v) * std::cos(v); }, kModes / 2))
    two.push_back(x);
  std::sort(two.begin(), two.end());
  out.push_back(compare(*make_beam(beam(2, 2), {}), "continuous beam of two spans", beam_hz(two, 0.5 * kLength_m)));
  constexpr Real kEnd = 30.0L, kMiddle = 80.0L;  // E I / l^3
  Roots sprung = roots_of([](Real x) { return two_spans(x, kEnd, kMiddle, true); }, kModes / 2);
  for (const Real x : roots_of([](Real v) { return two_spans(v, kEnd, kMiddle, false); }, kModes / 2))
    sprung.push_back(x);
  std::sort(sprung.begin(), sprung.end());
  Beam springs = beam(2, 2);
  const double unit = kEi_nm2 / std::pow(0.5 * kLength_m, 3);
  for (std::size_t i = 0; i < 3; ++i)
    springs.supports[i].displacement = Connection::spring(unit * static_cast<double>(i == 1 ? kMiddle : kEnd));
  out.push_back(compare(*make_beam(springs, {}), "two-span beam on springs", beam_hz(sprung, 0.5 * kLength_m)));
  Beam free = beam(1, 4);
  free.supports.assign(2, {Connection::free(), Connection::free()});
  out.push_back(compare(*make_beam(free, {}), "free beam",
                        beam_hz(roots_of([](Real x) { return std::cos(x) - 1.0L / std::cosh(x); }, kModes))));
  Beam pressed = beam(1, 4);  // f_n with axial force: (n pi)^4 + P L^2 / (E I) (n pi)^2
  pressed.axial_n = -0.6 * kEi_nm2 * static_cast<double>(kPi * kPi) / (kLength_m * kLength_m);
  Roots softened;
  for (const Real x : multiples_of_pi(kModes)) softened.push_back(std::pow(x * x * (x * x - 0.6L * kPi * kPi), 0.25L));
  out.push_back(compare(*make_beam(pressed, {}), "simply supported beam under 0.6 of Euler's load", beam_hz(softened)));
  // Timoshenko, simply supported: m w^2 = E I q^4 less shear and rotary inertia, a quadratic in w^2.
  Beam sheared = beam(1, 4);
  sheared.shear_n = 4.0e6, sheared.rotary_per_m_kgm = 30.0;
  std::vector<double> hz;
  for (const Real x : multiples_of_pi(kModes)) {
    const Real q = x / kLength_m, g = *sheared.shear_n, ei = kEi_nm2, m = kKgPerM, j = sheared.rotary_per_m_kgm;
    const Real b = g * q * q / m + (g + ei * q * q) / j, c = g * q * q * ei * q * q / (m * j);
    hz.push_back(static_cast<double>(std::sqrt(2.0L * c / (b + std::sqrt(b * b - 4.0L * c))) / (2.0L * kPi)));
  }
  out.push_back(compare(*make_beam(sheared, {}), "simply supported Timoshenko beam", hz));
}

void add_cables(std::vector<KindError>& out) {
  Cable cable;
  cable.length_m = 130.0, cable.mass_per_m_kg = 62.0, cable.tension_n = 2.9e6;
  const Real unit = std::sqrt(Real{cable.tension_n} / cable.mass_per_m_kg) / (2.0L * cable.length_m);
  std::vector<double> taut, stiff;
  for (std::size_t n = 1; n <= kModes; ++n) taut.push_back(static_cast<double>(static_cast<Real>(n) * unit));
  out.push_back(compare(*make_cable(cable, {}), "taut string", taut));
  cable.ei_nm2 = 9.0e5;
  for (std::size_t n = 1; n <= kModes; ++n) {
    const Real q = static_cast<Real>(n) * kPi / cable.length_m;
    stiff.push_back(taut[n - 1] * static_cast<double>(std::sqrt(1.0L + q * q * cable.ei_nm2 / cable.tension_n)));
  }
  out.push_back(compare(*make_cable(cable, {}), "taut string with bending, hinged", stiff));
  // Sag (Irvine & Caughey 1974): antisymmetric modes as taut, symmetric ones of tan(x/2) = x/2 - (4/l2) (x/2)^3.
  cable.ei_nm2 = 0.0, cable.ea_n = 1.4e9, cable.slope_deg = 28.0;
  const Real bow = cable.mass_per_m_kg * 9.80665L * std::cos(28.0L * kPi / 180.0L) * cable.length_m / cable.tension_n;
  const Real l2 = bow * bow * cable.ea_n / (cable.tension_n * (1.0L + bow * bow / 8.0L));
  Roots sagging = roots_of(
      [&](Real x) { return std::sin(x / 2) - std::cos(x / 2) * (x / 2 - 4.0L / l2 * x * x * x / 8.0L); }, kModes / 2);
  for (std::size_t n = 1; n <= kModes / 2; ++n) sagging.push_back(2.0L * static_cast<Real>(n) * kPi);
  std::sort(sagging.begin(), sagging.end());
  std::vector<double> hz;
  for (const Real x : sagging) hz.push_back(static_cast<double>(x / kPi * unit));
  out.push_back(compare(*make_cable(cable, {}), "cable with sag", hz));
}

void add_shear_frame(std::vector<KindError>& out) {
  ShearFrame frame;
  frame.mass.assign(kModes, 1.0), frame.stiffness_per_s2.assign(kModes, 1700.0);
  std::vector<double> hz;
  for (std::size_t r = 1; r <= kModes; ++r) {
    const Real angle = (2.0L * static_cast<Real>(r) - 1.0L) * kPi / (2.0L * (2.0L * kModes + 1.0L));
    hz.push_back(static_cast<double>(std::sqrt(1700.0L) * std::sin(angle) / kPi));
  }
  out.push_back(compare(*make_shear_storeys(frame, {}), "uniform frame", hz));
}

}  // namespace

std::vector<KindError> check_kinds() {
  std::vector<KindError> out;
  add_shear_frame(out);
  add_towers(out);
  add_beams(out);
  add_cables(out);
  return out;
}

void print_structure_kinds() {
  fmt::print("# kind, structure, compared with, modes, largest relative error of a frequency\n");
  for (const auto& errors : {check_kinds(), check_kinds_against_matrices()}) {
    for (const KindError& e : errors)
      fmt::print("kind\t{}\t{}\t{}\t{}\t{:.3e}\n", e.kind, e.structure, e.against, e.n_modes, e.worst);
  }
}

void print_structures(const std::string& what, int n_seeds, int n_threads, int first_seed, const std::string& folder) {
  if (what == "structure-kinds") return print_structure_kinds();
  if (what == "structure-effects") return print_structure_effects(n_seeds, n_threads, first_seed);
  if (what == "structure-where") return print_structure_where(n_seeds, n_threads, first_seed);
  if (what == "structure-tension") return print_structure_tension(n_seeds, n_threads, first_seed);
  write_large_structure(folder, first_seed);
}

}  // namespace tools
