// Tension of a stay cable filmed at 50 frames/s: motion of a hanging chain (hanging_chain.h) under wind, seen at a few
// tracked regions, identified by the product, fitted with the product's cable.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <optional>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "core/structure/effects/catalogue.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/mode_numbers.h"
#include "core/structure/place_profile.h"
#include "firmware_app/replay/analysis.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/hanging_chain.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/structures.h"

namespace tools {
namespace {

using core::structure::DeclaredFrame;
using core::structure::ReferenceMode;
using Eigen::Index;

constexpr double kFrames_hz = 50.0, kMostSought_hz = 20.0, kSoughtModes = 5.5;  // of the designed tension
// Shapes number the modes. Regions are placed to 0.2 % of the chord, 3 % of a component in the fifth mode: the
// declared shape_sigma, of which closeloop takes at least a tenth.
constexpr double kPlaceSigma = 0.002, kShapeSigma = 1.0;
constexpr int kMovingModes = 20, kDeclaredModes = 12;

// Steel strands: 195 GPa, 7850 kg/m^3 and 15 % of sheath, 400 .. 700 MPa.
struct DrawnStay {
  HangingChain truth;
  core::structure::Cable declared;
  std::vector<double> places, declared_places;  // of the tracked regions, shares of the chord
  double damping = 0.0, rms_px = 0.0, noise_px = 0.0;
};

DrawnStay draw_stay(std::uint64_t seed) {
  Draw draw(seed, "stay");
  DrawnStay out;
  HangingChain& t = out.truth;
  t.chord_m = draw.uniform(60.0, 200.0), t.slope_deg = draw.uniform(20.0, 60.0);
  t.mass_per_m_kg = draw.uniform(40.0, 110.0);
  const double area = t.mass_per_m_kg / (1.15 * 7850.0);
  t.tension_n = draw.uniform(400e6, 700e6) * area, t.ea_n = 195e9 * area;
  // Declared: 0.7 of a solid round bar, known to 30 %; the tension from the design, to 30 %.
  const double solid = 195e9 * area * area / (4.0 * std::numbers::pi);
  core::structure::Cable& d = out.declared;
  d.length_m = t.chord_m, d.slope_deg = t.slope_deg, d.mass_per_m_kg = t.mass_per_m_kg, d.ea_n = t.ea_n;
  d.ei_nm2 = 0.7 * solid, d.ei_prior = 0.3, d.tension_prior = 0.3;
  d.end_rotation = core::structure::Connection::rigid();
  t.ei_nm2 = d.ei_nm2 * std::clamp(1.0 + 0.3 * draw.gaussian(), 0.2, 1.8);
  d.tension_n = t.tension_n / std::clamp(1.0 + 0.15 * draw.gaussian(), 0.6, 1.4);
  const double first = draw.uniform(0.06, 0.15), last = draw.uniform(0.4, 0.7);
  const int n = draw.whole(5, 8);
  for (int i = 0; i < n; ++i) out.places.push_back(first + (last - first) * i / (n - 1));
  out.damping = draw.log_uniform(0.001, 0.006);
  out.rms_px = draw.uniform(0.5, 3.0), out.noise_px = draw.log_uniform(0.01, 0.05);
  for (const double place : out.places) out.declared_places.push_back(place + kPlaceSigma * draw.gaussian());
  return out;
}

// One mode under white force, stepped exactly: q' = A q + B with the covariance of the force's share (Gardiner,
// Handbook of Stochastic Methods, 4.4: stationary variance less that which is left after the step).
class MovingMode {
 public:
  MovingMode(double hz, double damping, double rms, Draw draw) : draw_(draw) {
    const double w = 2.0 * std::numbers::pi * hz, wd = w * std::sqrt(1.0 - damping * damping), dt = 1.0 / kFrames_hz;
    const double e = std::exp(-damping * w * dt), c = std::cos(wd * dt), s = std::sin(wd * dt);
    step_ << e * (c + damping * w / wd * s), e * s / wd, -e * w * w / wd * s, e * (c - damping * w / wd * s);
    Eigen::Matrix2d still = Eigen::Matrix2d::Zero();
    still(0, 0) = rms * rms, still(1, 1) = w * w * rms * rms;
    state_ = {rms * draw_.gaussian(), w * rms * draw_.gaussian()};
    const Eigen::Matrix2d share = still - step_ * still * step_.transpose();
    root_(0, 0) = std::sqrt(std::max(share(0, 0), 0.0));
    root_(1, 0) = root_(0, 0) > 0.0 ? share(1, 0) / root_(0, 0) : 0.0;
    root_(1, 1) = std::sqrt(std::max(share(1, 1) - root_(1, 0) * root_(1, 0), 0.0));
  }
  double next() {
    const double a = draw_.gaussian(), b = draw_.gaussian();
    state_ = step_ * state_ + root_ * Eigen::Vector2d(a, b);
    return state_(0);
  }

 private:
  Eigen::Matrix2d step_ = Eigen::Matrix2d::Zero(), root_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d state_;
  Draw draw_;
};

// Wind: the same force on each mode, so that motion falls as f^-3/2. All modes move, also those above the highest seen.
app::ChannelSeries filmed(const DrawnStay& stay, const ChainModes& modes, double duration_s, std::uint64_t seed) {
  std::vector<MovingMode> moving;
  const double first_hz = modes.frequency_hz(0);
  const double largest = modes.shapes.col(0).cwiseAbs().maxCoeff();
  Draw dampings(seed, "stay.damping");
  for (Index r = 0; r < modes.frequency_hz.size(); ++r) {
    const double hz = modes.frequency_hz(r), damping = stay.damping * dampings.uniform(0.7, 1.3);
    moving.emplace_back(hz, damping,
                        stay.rms_px / largest * std::pow(hz / first_hz, -1.5) * std::sqrt(stay.damping / damping),
                        Draw(seed, fmt::format("stay.mode.{}", r)));
  }
  app::ChannelSeries out;
  out.rate_hz = kFrames_hz, out.unit = "px";
  Draw noise(seed, "stay.noise");
  for (std::size_t i = 0; i < stay.places.size(); ++i) {
    core::ChannelInfo channel;
    channel.name = fmt::format("r{}", i + 1), channel.region = static_cast<std::uint16_t>(i);
    out.channels.push_back(std::move(channel));
  }
  out.value.resize(stay.places.size());
  for (int k = 0; k < static_cast<int>(duration_s * kFrames_hz); ++k) {
    Eigen::VectorXd seen = Eigen::VectorXd::Zero(modes.shapes.rows());
    for (Index r = 0; r < modes.frequency_hz.size(); ++r)
      seen += modes.shapes.col(r) * moving[static_cast<std::size_t>(r)].next();
    for (std::size_t i = 0; i < out.value.size(); ++i)
      out.value[i].push_back(seen(static_cast<Index>(i)) + stay.noise_px * noise.gaussian());
  }
  return out;
}

std::vector<ReferenceMode> measured(const app::ChannelSeries& series, const DeclaredFrame& declared) {
  app::SeriesOptions options;
  options.identifier.max_frequency_hz = std::min(kMostSought_hz, kSoughtModes * declared.numbering->frequency_hz(0));
  std::vector<ReferenceMode> out;
  for (const core::Mode& mode : identify_series(series, options).estimate.modes) {
    ReferenceMode one;
    one.number = static_cast<int>(out.size()) + 1;
    one.frequency_hz = mode.frequency_hz;
    one.sigma_hz = mode.frequency_std_hz.value_or(declared.frequency_sigma * mode.frequency_hz);
    for (std::size_t c = 0; c < mode.shape.size(); ++c) {
      one.shape.push_back(mode.shape[c].real());
      // As hovermodal closeloop reads modal.json.
      one.shape_sigma.push_back(
          std::max(c < mode.shape_std.size() ? mode.shape_std[c] : declared.shape_sigma, 0.1 * declared.shape_sigma));
    }
    out.push_back(std::move(one));
  }
  pair_with_model(declared, out);
  return out;
}

struct Tension {
  double true_n = 0.0, found_n = 0.0, sigma_n = 0.0;  // sigma 0: none
  int modes = 0, effects = 0;
};

Tension tension_of(double duration_s, std::uint64_t seed) {
  const DrawnStay stay = draw_stay(seed);
  const ChainModes modes = chain_modes(stay.truth, stay.places, kMovingModes);
  std::vector<core::structure::Sight> sights;
  for (std::size_t i = 0; i < stay.places.size(); ++i)
    sights.push_back({fmt::format("r{}", i + 1),
                      {stay.declared_places[i] * stay.declared.length_m, 0.0, 0.0},
                      Eigen::Vector3d::UnitZ()});
  DeclaredFrame declared = declare(make_cable(stay.declared, sights), kDeclaredModes);
  declared.stiffness_over_mass_per_s2 = 1.0;  // length and mass are known
  declared.shape_sigma = kShapeSigma;
  const auto reference = measured(filmed(stay, modes, duration_s, seed), declared);
  Tension out{stay.truth.tension_n, 0.0, 0.0, static_cast<int>(reference.size()), 0};
  if (reference.size() < 2) return out;
  core::closure::StructureLevel level(declared, reference);
  core::closure::ClosureOptions options;
  options.seed = seed, options.n_surrogates_when_plain = 32;
  core::structure::FrameModel model{&declared, {}};
  auto fit = fit_frame(model, reference, {}, core::structure::Starts::kAll);
  for (const auto& step : close_loop(level, options).steps) {
    for (const auto& effect : core::structure::structural_effects()) {
      if (effect->name() == step.effect) model.effects.push_back(effect.get());
    }
    fit = fit_frame(model, reference, fit.parameters, core::structure::Starts::kAll);
    ++out.effects;
  }
  if (!fit.ok) return out;
  out.found_n = values_of(model, fit.parameters)(static_cast<Index>(model.with_prior().front()));
  out.sigma_n =
      identifiability(model, fit).front().sigma_over_prior * stay.declared.tension_prior * stay.declared.tension_n;
  return out;
}

}  // namespace

void print_structure_tension(int n_seeds, int n_threads, int first_seed) {
  fmt::print(
      "# a stay cable filmed at 50 frames/s: record s, stays, with a tension, within its 95 % interval (1.96 sigma), "
      "sigma %: median, largest; error %: rms, largest; error over sigma rms; modes, least and most; stays with an "
      "effect reported\n");
  for (const double duration_s : {60.0, 180.0}) {
    const auto all = for_each_seed(
        n_seeds, n_threads, [&](std::uint64_t seed) { return tension_of(duration_s, seed); }, first_seed);
    int found = 0, inside = 0, effects = 0, least = 99, most = 0;
    std::vector<double> sigma, error;
    double squares = 0.0, scaled = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Tension& one = all[i];
      least = std::min(least, one.modes), most = std::max(most, one.modes);
      effects += one.effects > 0 ? 1 : 0;
      const double off = one.found_n - one.true_n;
      fmt::print("stay\t{:g}\t{}\t{:.0f}\t{:.0f}\t{:.0f}\t{}\t{}\n", duration_s, first_seed + static_cast<int>(i),
                 one.true_n, one.found_n, one.sigma_n, one.modes, one.effects);
      if (!(one.sigma_n > 0.0)) continue;
      ++found;
      inside += std::abs(off) <= 1.96 * one.sigma_n ? 1 : 0;
      sigma.push_back(100.0 * one.sigma_n / one.true_n), error.push_back(100.0 * std::abs(off) / one.true_n);
      squares += error.back() * error.back(), scaled += off * off / (one.sigma_n * one.sigma_n);
    }
    std::sort(sigma.begin(), sigma.end()), std::sort(error.begin(), error.end());
    const auto n = static_cast<double>(found);
    fmt::print("tension\t{:g}\t{}\t{}\t{}\t{:.3f}\t{:.3f}\t{:.3f}\t{:.3f}\t{:.2f}\t{}\t{}\t{}\n", duration_s,
               all.size(), found, inside, found > 0 ? sigma[sigma.size() / 2] : std::nan(""),
               found > 0 ? sigma.back() : std::nan(""), std::sqrt(squares / n), found > 0 ? error.back() : std::nan(""),
               std::sqrt(scaled / n), least, most, effects);
  }
}

}  // namespace tools
