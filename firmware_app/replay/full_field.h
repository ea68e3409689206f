#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/identification/field_shapes.h"
#include "core/types/cpsd.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// Records of many channels (a full field): modes are identified from a core of channels, with all their pairs; the
// others get their components from their correlations with the core's references (core/identification/field_shapes.h).
// Time and memory grow with the number of channels; with all pairs, 150 channels need more than 8 GB.

// Up to so many channels all of them are identified together.
inline constexpr std::size_t kMostTogether = 24;

// The core of a series: bases and requested references, then, up to twelve, the channel that moves most once what those
// chosen before it explain is taken out, again and again (pivoting; first differences, so that slow drift does not
// decide). Channels that miss more than 2 % of their samples are chosen last. Ascending; `references` receives the
// indices, within the core, of the first six chosen that are no base.
struct FieldCore {
  std::vector<std::size_t> channels;
  std::vector<int> references;
};
[[nodiscard]] FieldCore choose_core(const ChannelSeries& series, const std::vector<int>& references);

[[nodiscard]] ChannelSeries channels_of(const ChannelSeries& series, const std::vector<std::size_t>& channels);

using SumsOf = std::function<const core::CpsdSums&(const ChannelSeries&)>;  // valid until the next call

// Adds the components of all other channels to an estimate of the core's; afterwards its shapes, and its channels, are
// those of `series`. sums_of: the sums of a series, with the same segments as the core's. A component that the
// core's correction of a shape leaves open is 0, with a note in the mode's reason.
void add_field(const ChannelSeries& series, const FieldCore& core, const core::FieldShapes& field,
               const std::vector<double>& delay_s, const SumsOf& sums_of, core::ModalEstimate& estimate);

}  // namespace app
