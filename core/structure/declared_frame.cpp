#include "core/structure/declared_frame.h"

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

namespace core::structure {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw std::invalid_argument(text.str());
}

void require(double value, double low, double high, const std::string& what) {
  if (!(value >= low && value <= high)) refuse(what, ": ", value, " is refused: allowed ", low, " .. ", high);
}

void require_each(const std::vector<double>& values, std::size_t n, const std::string& what) {
  if (values.empty()) return;
  if (values.size() != n) refuse(what, ": ", values.size(), " values for ", n, " storeys; give one each, lowest first");
  for (const double value : values) require(value, 1e-6, 1e6, what);
}

}  // namespace

DeclaredFrame declare(std::shared_ptr<const StructuralModel> model, std::size_t n_modes) {
  DeclaredFrame out;
  auto modes = model->modes(declared_values(*model), n_modes, {});
  if (!modes)
    refuse("the ", model->kind(),
           " as declared has no modes: it buckles or a part of it is held by nothing; check "
           "supports, axial forces and units");
  out.n_storeys = static_cast<std::size_t>(modes->frequency_hz.size());
  out.numbering = std::make_shared<const ModelModes>(std::move(*modes));
  for (const Sight& sight : model->sights()) out.floors.push_back(sight.channel);
  out.model = std::move(model);
  return out;
}

void validate(const DeclaredFrame& frame) {
  if (frame.n_storeys < 1 || frame.n_storeys > kMaxStoreys)
    refuse("storeys: ", frame.n_storeys, " is refused: allowed 1 .. ", kMaxStoreys);
  require_each(frame.mass, frame.n_storeys, "masses");
  require_each(frame.stiffness_ratio, frame.n_storeys, "stiffness_ratio");
  if (frame.storey_height_mm) require(*frame.storey_height_mm, 1.0, 1e5, "storey_height_mm");
  if (frame.stiffness_over_mass_per_s2) require(*frame.stiffness_over_mass_per_s2, 1e-6, 1e12, "stiffness_over_mass");
  if (frame.dt_s) require(*frame.dt_s, 1e-9, 1e3, "dt_s");
  if (frame.temperature) {
    require(frame.temperature->stiffness_per_k, -0.05, 0.05, "stiffness_per_k");
    require(frame.temperature->axial_n_per_k, -1e12, 1e12, "axial_n_per_k");
  }
  require(frame.frequency_sigma, 1e-6, 0.2, "frequency_sigma");
  require(frame.shape_sigma, 1e-4, 1.0, "shape_sigma");
  if (!frame.floors.empty() && frame.floors.size() != frame.n_components())
    refuse("floors: ", frame.floors.size(), " names for ", frame.n_components(),
           frame.model ? " regions; give one each" : " storeys; give one each, lowest first");
}

void validate(const DeclaredFrame& frame, const std::vector<ReferenceMode>& reference) {
  validate(frame);
  if (reference.size() < 2)
    refuse("the reference holds ", reference.size(), " modes; two or more are needed to leave one out");
  std::set<int> numbers;
  double last_hz = 0.0;
  int last = 0;
  for (const ReferenceMode& mode : reference) {
    if (mode.number < 1 || static_cast<std::size_t>(mode.number) > frame.n_storeys)
      refuse("mode ", mode.number, " of the reference: ",
             frame.model ? "the model of the " + std::string(frame.model->kind())
                         : "a frame of " + std::to_string(frame.n_storeys) + " storeys",
             " has modes 1 .. ", frame.n_storeys,
             frame.model ? "; leave the mode out" : "; declare more storeys, or leave the mode out");
    if (!numbers.insert(mode.number).second) refuse("mode ", mode.number, " stands twice in the reference; keep one");
    require(mode.frequency_hz, 1e-6, 1e9, "frequency of mode " + std::to_string(mode.number));
    require(mode.sigma_hz / mode.frequency_hz, 1e-7, 0.5, "relative sigma of mode " + std::to_string(mode.number));
    // Of another kind, two modes of the structure may stand in another order than those of the model.
    if (!frame.model && (mode.number <= last || mode.frequency_hz <= last_hz))
      refuse("mode ", mode.number, " at ", mode.frequency_hz, " Hz follows mode ", last, " at ", last_hz,
             " Hz; modes count upwards with their frequencies");
    last = mode.number;
    last_hz = mode.frequency_hz;
    if (!mode.shape.empty() &&
        (mode.shape.size() != frame.n_components() || mode.shape_sigma.size() != frame.n_components()))
      refuse("shape of mode ", mode.number, ": ", mode.shape.size(), " components for ", frame.n_components(),
             frame.model ? " regions" : " storeys");
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
      require(mode.shape[i], -1e3, 1e3, "shape of mode " + std::to_string(mode.number));
      require(mode.shape_sigma[i], 1e-7, 1e3, "sigma of the shape of mode " + std::to_string(mode.number));
    }
  }
}

}  // namespace core::structure
