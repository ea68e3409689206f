#include "firmware_app/chain/structure_comparison.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/structure/mode_numbers.h"
#include "firmware_app/chain/end_when_stopped.h"
#include "firmware_app/chain/reference_modes.h"
#include "rt/clock.h"

namespace app {
namespace {
constexpr std::size_t kSurrogatesWhenPlain = 32;  // another kind than a shear frame costs more for each
}  // namespace

MeasuredModes paired_with(const core::structure::DeclaredFrame& declared,
                          std::vector<core::structure::ReferenceMode> modes) {
  MeasuredModes out{std::move(modes), {}};
  if (declared.model) out.unpaired = core::structure::pair_with_model(declared, out.paired);
  return out;
}

StructureFinding compare_structure(const core::structure::DeclaredFrame& declared, MeasuredModes measured,
                                   core::closure::ClosureOptions options,
                                   std::vector<core::structure::ReferenceMode> check) {
  if (declared.model) options.n_surrogates_when_plain = std::min(options.n_surrogates, kSurrogatesWhenPlain);
  StructureFinding out;
  out.level = std::make_unique<core::closure::StructureLevel>(declared, std::move(measured.paired), std::move(check),
                                                              std::move(measured.unpaired));
  out.result = core::closure::close_loop(*out.level, options);
  return out;
}

StructureComparison::StructureComparison(core::structure::DeclaredFrame declared,
                                         const std::vector<core::ChannelInfo>& channels, double period_s)
    : declared_(std::move(declared)),
      period_ns_(static_cast<std::int64_t>(1e9 * period_s)),
      next_ns_(std::numeric_limits<std::int64_t>::min()) {
  for (const core::ChannelInfo& channel : channels) channel_names_.push_back(channel.name);
}

bool StructureComparison::is_due(const core::ModalEstimate& estimate) const noexcept {
  return !estimate.modes.empty() && estimate.t_stream_ns >= next_ns_;
}

core::closure::ClosureReport StructureComparison::report(const core::ModalEstimate& estimate,
                                                         const std::function<bool()>& goes_on) {
  const std::int64_t begin_ns = rt::monotonic_ns();
  next_ns_ = estimate.t_stream_ns + period_ns_;
  core::closure::ClosureReport out;
  out.number = n_reports_++;
  out.t_stream_ns = estimate.t_stream_ns;
  out.last_sequence = estimate.n_samples > 0 ? estimate.n_samples - 1 : 0;
  out.duration_s = estimate.duration_s;
  core::closure::ClosureOptions options;
  options.progress = end_when_stopped(goes_on);
  out.result.level = "structure";
  try {
    MeasuredModes measured = paired_with(declared_, reference_modes(estimate, channel_names_, declared_));
    out.result = compare_structure(declared_, std::move(measured), options).result;
  } catch (const std::invalid_argument& e) {
    out.refused = e.what();
  }
  out.took_s = 1e-9 * static_cast<double>(rt::monotonic_ns() - begin_ns);
  return out;
}

}  // namespace app
