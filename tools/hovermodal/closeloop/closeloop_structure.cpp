// hovermodal closeloop --structure: a declared structure of any kind against measured modes.
#include "tools/hovermodal/closeloop/closeloop_structure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "core/structure/damping_law.h"
#include "core/structure/place_profile.h"
#include "drivers/storage/json.h"
#include "drivers/storage/structure_file.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/structure_comparison.h"
#include "firmware_app/report/closure_json.h"
#include "firmware_app/report/closure_modes_svg.h"
#include "firmware_app/report/structure_level_pictures.h"
#include "tools/hovermodal/closeloop/closing.h"
#include "tools/hovermodal/closeloop/reference.h"

namespace tools {
namespace {

using core::closure::StructureLevel;
using core::structure::DeclaredFrame;
using core::structure::FrameFit;
using core::structure::FrameModel;
using Reference = std::vector<core::structure::ReferenceMode>;

std::string check_text(const StructureLevel& level) {
  if (level.check().empty()) return {};
  std::string out = "modes excluded from the fit (--check): predicted, given, error\n";
  const auto modes = level.model_modes();
  for (const auto& mode : level.check()) {
    const double hz = modes.frequency_hz(mode.number - 1);
    out += fmt::format("{:4}  {:10.4f}  {:10.4f}  {:+7.3f} %\n", mode.number, hz, mode.frequency_hz,
                       100.0 * (hz / mode.frequency_hz - 1.0));
  }
  return out;
}

std::string hz_text(const Reference& modes) {
  std::vector<double> hz;
  for (const auto& mode : modes) hz.push_back(mode.frequency_hz);
  return fmt::format("{:.4g} Hz", fmt::join(hz, ", "));
}

app::MeasuredModes measured(const std::string& path, const DeclaredFrame& declared) {
  app::MeasuredModes out = app::paired_with(declared, read_reference(path, declared));
  if (declared.model && out.paired.size() < 2 && !out.unpaired.empty()) {
    const Eigen::VectorXd& hz = declared.numbering->frequency_hz;
    throw drivers::FileError(fmt::format(
        "{}: of its modes at {} fewer than two are modes of the model, which has {:.4g} .. {:.4g} Hz; check the "
        "units of stiffness and mass, or declare stiffness: fitted",
        path, hz_text(out.unpaired), hz(0), hz(hz.size() - 1)));
  }
  return out;
}

// Places that explain the modes as well as the one found.
std::string places_text(const StructureLevel& level) {
  std::string out;
  const std::size_t n_effects = level.model().effects.size();
  for (std::size_t i = 0; i < n_effects; ++i) {
    const auto places = place_profile(level.model(), level.reference(), level.fitted(), i, level.spread());
    if (places.empty()) continue;
    out += fmt::format("places of {} that the modes do not distinguish (chi-square within 95 %):\n",
                       level.model().effects[i]->name());
    for (const auto& place : places) {
      if (place.is_indistinguishable) out += fmt::format("  {:8.1f}  {}\n", place.chi2, place.meaning);
    }
  }
  return out;
}

// The mechanism of damping, of all measured modes.
std::string damping_text(const app::MeasuredModes& reference) {
  Reference all = reference.paired;
  all.insert(all.end(), reference.unpaired.begin(), reference.unpaired.end());
  return damping_words(core::structure::damping_verdict(all));
}

// A factor that no structure's properties are wrong by, but units are.
std::string units_text(const StructureLevel& level) {
  constexpr double kMostFactor = 20.0;
  if (!level.fitted().ok || !level.model().has_scale()) return {};
  const double factor = std::exp(level.fitted().parameters(0));
  if (factor < kMostFactor && factor > 1.0 / kMostFactor) return {};
  return fmt::format("stiffness over mass is {:.3g} times the declared one: check the units of stiffness and mass\n",
                     factor);
}

// Posterior of the parameters that have a prior, and which of them the modes determine.
std::string parameters_text(const StructureLevel& level) {
  std::string out;
  const FrameModel& model = level.model();
  const FrameFit& fit = level.fitted();
  const auto posterior = core::structure::identifiability(model, fit);
  if (posterior.empty()) return out;
  const Eigen::VectorXd values = values_of(model, fit.parameters);
  const Eigen::MatrixXd covariance = parameter_covariance(fit);
  const auto& parameters = model.declared->model->parameters();
  const std::vector<std::size_t> all = model.with_prior();
  const Eigen::Index first = model.has_scale() ? 1 : 0;
  out += "parameters with a prior: declared, fitted, sigma, sigma over that of the prior\n";
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& p = parameters[all[k]];
    const double share = posterior[k].sigma_over_prior;
    out += fmt::format("  {:<24}{:12.5g} {:12.5g} {:10.3g} {} {:6.3f}{}\n", p.name, p.value,
                       values(static_cast<Eigen::Index>(all[k])), share * p.prior_sigma, p.unit, share,
                       share > 0.9 ? "  the modes do not determine it" : "");
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto a = first + static_cast<Eigen::Index>(i), b = first + static_cast<Eigen::Index>(k);
      const double correlation = covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
      if (std::abs(correlation) > 0.9) {
        out += fmt::format("  {} and {}: correlation {:.2f}; only their combination is determined\n",
                           parameters[all[k]].name, parameters[all[i]].name, correlation);
      }
    }
  }
  return out;
}

}  // namespace

void close_structure(const LoopRequest& request, const std::string& structure, const std::string& check_path) {
  const DeclaredFrame declared = drivers::read_structure(structure);
  const app::MeasuredModes reference = measured(request.reference, declared);
  app::MeasuredModes check = check_path.empty() ? app::MeasuredModes{} : measured(check_path, declared);
  if (!check.unpaired.empty())
    request.answer.note("modes of {} that none of the model's is: {}\n", check_path, hz_text(check.unpaired));
  core::closure::ClosureOptions loop;
  loop.n_surrogates = request.n_surrogates;
  loop.seed = request.seed;
  const auto compared = [&] {
    const ProgressLine line(request.answer);
    loop.progress = line.teller();
    try {
      return app::compare_structure(declared, reference, loop, std::move(check.paired));
    } catch (const std::invalid_argument& error) {
      throw drivers::FileError(request.reference + (check_path.empty() ? "" : " or " + check_path) + ": " +
                               error.what());
    }
  };
  auto [level, result] = compared();
  std::erase_if(result.not_observable, [](const auto& one) { return one.reason == core::structure::kOtherKind; });
  keep_earlier_closure(request.report);
  if (!request.report.empty()) {
    const std::filesystem::path folder = request.report;
    drivers::write_file_atomically((folder / "closure_modes.svg").string(), app::closure_modes_svg(result));
    for (const app::StructurePicture& one : app::structure_level_pictures(*level, result, declared))
      drivers::write_file_atomically((folder / (one.name + ".svg")).string(), one.svg);
  }
  std::string more = check_text(*level);
  if (declared.model) more += places_text(*level) + parameters_text(*level);
  if (const std::string words = damping_text(reference); !words.empty()) more += words + "\n";
  show_closure(request.answer, result, more, request.report);
  if (!declared.model) return;
  if (const Reference left = level->unpaired(); !left.empty())
    request.answer.note("modes of {} that none of the model's is: {}\n", request.reference, hz_text(left));
  request.answer.note("{}", units_text(*level));
}

}  // namespace tools
