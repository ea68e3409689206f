// StructureLevel: which measured mode is which mode of the model.
#include <algorithm>
#include <optional>
#include <utility>

#include "core/closure/structure_level.h"
#include "core/structure/paired_fit.h"

namespace core::closure {

using structure::FrameFit;
using structure::FrameModel;
using structure::PairedFit;
using structure::Starts;

// Whether the same modes take part.
bool StructureLevel::covers(const std::vector<int>& number) const {
  return std::equal(number.begin(), number.end(), number_.begin(), number_.end(),
                    [](int a, int b) { return (a == 0) == (b == 0); });
}

// After a fit of model_ under number_. An effect may move modes so far that the model without it pairs them wrongly, or
// not at all. Modes take part as in that model, with an effect or without, which explains all measured modes best; each
// model then numbers them in its own way, so that errors of all models are those of the same modes.
void StructureLevel::settle_numbers() {
  const std::vector<Effect> effects = open();
  candidate_number_.assign(effects.size(), number_);
  if (!declared_.model || !is_ambiguous(pairing_of(model_, fit_, measured_))) return;
  const PairedFit own = fit_paired(model_, measured_, number_, fit_.parameters);
  std::vector<PairedFit> with_effect;
  with_effect.reserve(effects.size());
  const PairedFit* best = &own;
  for (const Effect effect : effects)
    with_effect.push_back(fit_paired(with(effect), measured_, number_, fit_.parameters));
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const PairedFit& one = with_effect[i];
    if (!one.fit.ok || !implausible(with(effects[i]), one.fit).empty()) continue;
    if (!best->fit.ok || one.cost < best->cost) best = &one;
  }
  if (!best->fit.ok) return;
  number_ = best->number;
  if (own.fit.ok && covers(own.number)) number_ = own.number;
  reference_ = structure::numbered(measured_, number_);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const bool has_own = with_effect[i].fit.ok && covers(with_effect[i].number);
    candidate_number_[i] = has_own ? with_effect[i].number : number_;
  }
  fit_ = fit_frame(model_, reference_, fit_.parameters, Starts::kAll);
}

// The modes that take part under the numbers of another model, `fit` its fit under number_. Empty: they are number_.
std::optional<StructureLevel::Reference> StructureLevel::under_own_numbers(const FrameModel& model,
                                                                           const FrameFit& fit) const {
  if (!declared_.model) return std::nullopt;
  const structure::Pairing pairing = pairing_of(model, fit, measured_);
  if (pairing.number == number_ && !is_ambiguous(pairing)) return std::nullopt;
  const PairedFit own = fit_paired(model, measured_, number_, fit.parameters);
  if (!own.fit.ok || !covers(own.number) || own.number == number_) return std::nullopt;
  return structure::numbered(measured_, own.number);
}

StructureLevel::Reference StructureLevel::unpaired() const {
  Reference out;
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    if (number_[i] == 0) out.push_back(measured_[i]);
  }
  return out;
}

}  // namespace core::closure
