// Residual diagnosis of series of channels: results with a known undeclared effect, and without any.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "core/closure/closure_loop.h"
#include "core/closure/response/channel_model.h"
#include "core/closure/response/response_level.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_series_cases.h"
#include "tools/validate/identification.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::closure::ClosureResult;
using core::closure::ResponseModel;
using core::simulation::Scene;

constexpr std::size_t kSurrogates = 64, kWhenPlain = 12;

// A model from whose catalogue one effect has been removed.
class Lacking final : public ResponseModel {
 public:
  Lacking(const ResponseModel& whole, std::string effect) : whole_(whole), effect_(std::move(effect)) {}
  Lacking(std::unique_ptr<ResponseModel> own, std::string effect)
      : own_(std::move(own)), whole_(*own_), effect_(std::move(effect)) {}

  std::string unit() const override { return whole_.unit(); }
  std::vector<std::string> effects() const override {
    std::vector<std::string> all = whole_.effects();
    std::erase(all, effect_);
    return all;
  }
  std::vector<core::closure::NotObservable> not_observable() const override { return whole_.not_observable(); }
  double material_share(const std::string& effect) const override { return whole_.material_share(effect); }
  core::closure::ResponseFit fit(const std::vector<std::string>& effects) const override { return whole_.fit(effects); }
  std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>& effects, std::uint64_t seed) const override {
    return std::make_unique<Lacking>(whole_.surrogate(effects, seed), effect_);
  }

 private:
  std::unique_ptr<ResponseModel> own_;
  const ResponseModel& whole_;
  std::string effect_;
};

ClosureResult close(const ResponseModel& model, std::uint64_t seed) {
  core::closure::ResponseLevel level(model);
  core::closure::ClosureOptions options;
  options.seed = seed;
  options.n_surrogates = kSurrogates;
  options.n_surrogates_when_plain = kWhenPlain;
  return core::closure::close_loop(level, options);
}

std::vector<std::string> names_of(const ClosureResult& result) {
  std::vector<std::string> names;
  for (const auto& step : result.steps) names.push_back(step.effect);
  return names;
}

// The effect's stated value compared with the truth.
struct Stated {
  double value = std::nan(""), sigmas_off = std::nan("");  // infinite: no sigma stated
};
Stated stated_number(const ClosureResult& result, const std::string& effect, double truth) {
  for (const auto& step : result.steps) {
    if (step.effect != effect || step.parameters.empty()) continue;
    const auto& first = step.parameters.front();
    return {first.value, parameter_errors(result.steps, effect, {{first.name, truth}}).worst_sigmas};
  }
  return {};
}

std::string series_line(const SeriesCase& one, std::uint64_t seed) {
  Scene scene = series_scene(seed, false);
  one.apply(scene);
  const CountedSeries series = counted_series(scene);
  const ClosureResult result = close(core::closure::ChannelModel(series.record), seed);
  const double truth = one.truth(scene, series);
  const Stated stated = stated_number(result, one.effect, truth);
  return fmt::format("series\t{}\t{}\t{}\t{}\t{:.4g}\t{:.4g}\t{:.2f}\t{:.4f}\t{:.4f}\n", one.effect, one.strength, seed,
                     result.steps.empty() ? "nothing" : fmt::format("{}", fmt::join(names_of(result), " + ")), truth,
                     stated.value, stated.sigmas_off, result.reference_error_before.value_or(std::nan("")),
                     result.reference_error_after.value_or(std::nan("")));
}

std::string outside_line(const SeriesCase& one, std::uint64_t seed) {
  Scene scene = series_scene(seed, false);
  one.apply(scene);
  const CountedSeries series = counted_series(scene);
  const core::closure::ChannelModel whole(series.record);
  const ClosureResult lacking = close(Lacking(whole, one.effect), seed), named = close(whole, seed);
  const bool latent = !lacking.steps.empty() && std::all_of(lacking.steps.begin(), lacking.steps.end(), [](auto& s) {
    return s.kind == core::closure::EffectKind::kLatent;
  });
  const double nan = std::nan("");
  return fmt::format("series-outside\t{}\t{}\t{}\t{}\t{:d}\t{:.4f}\t{:.4f}\t{:.4f}\n", one.effect, one.strength, seed,
                     lacking.steps.empty() ? "nothing" : fmt::format("{}", fmt::join(names_of(lacking), " + ")), latent,
                     lacking.reference_error_before.value_or(nan), lacking.reference_error_after.value_or(nan),
                     named.reference_error_after.value_or(nan));
}

template <class Line>
void print_lines(const IdentificationOptions& options, Line line) {
  for (const std::string& text : for_each_seed(options.n_seeds, options.n_threads, line, options.first_seed))
    fmt::print("{}", text);
  std::fflush(stdout);
}

}  // namespace

void print_closure_series(const IdentificationOptions& options) {
  fmt::print(
      "# 120 s of a drawn structure: effect, strength, seed, named, its true number, the stated one, their difference "
      "in "
      "stated sigmas (inf: none stated), held-out innovations before, after\n");
  for (const SeriesCase& one : series_cases())
    print_lines(options, [&](std::uint64_t seed) { return series_line(one, seed); });
}

void print_closure_series_outside(const IdentificationOptions& options) {
  fmt::print(
      "# effect taken out of the catalogue, strength, seed, reported, all latent, held-out innovations before, after, "
      "after with the whole catalogue\n");
  for (const SeriesCase& one : series_cases()) {
    // Effects with a pattern in time; lost and repeated frames are events, jitter is noise.
    const std::string effect = one.effect;
    if (effect != "frequency_drift" && effect != "softening") continue;
    print_lines(options, [&](std::uint64_t seed) { return outside_line(one, seed); });
  }
}

void print_closure_series_null(const IdentificationOptions& options) {
  fmt::print("# no effect: input, seed, adopted; wind has seeds of its own\n");
  IdentificationOptions of_input = options;
  for (const bool wind : {false, true}) {
    print_lines(of_input, [&](std::uint64_t seed) {
      const CountedSeries series = counted_series(series_scene(seed, wind));
      const ClosureResult result = close(core::closure::ChannelModel(series.record), seed);
      return fmt::format("series-null\t{}\t{}\t{}\n", wind ? "wind" : "shaken", seed,
                         result.steps.empty() ? "nothing" : fmt::format("{}", fmt::join(names_of(result), " + ")));
    });
    of_input.first_seed += options.n_seeds;
  }
}

}  // namespace tools
