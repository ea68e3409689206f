#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "core/structure/declared_frame.h"
#include "core/types/closure_report.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace app {

// Measured modes beside a declared structure: those that are modes of its model, and others. A shear frame has no
// model of its own: all are paired, by their numbers.
struct MeasuredModes {
  std::vector<core::structure::ReferenceMode> paired, unpaired;
};
[[nodiscard]] MeasuredModes paired_with(const core::structure::DeclaredFrame& declared,
                                        std::vector<core::structure::ReferenceMode> modes);

// A declared structure after comparison with measured modes: which effects it lacks.
struct StructureFinding {
  std::unique_ptr<core::closure::StructureLevel> level;
  core::closure::ClosureResult result;
};
// `check`: modes that no fit uses, to be predicted. Throws std::invalid_argument if the modes do not allow a
// comparison.
[[nodiscard]] StructureFinding compare_structure(const core::structure::DeclaredFrame& declared, MeasuredModes measured,
                                                 core::closure::ClosureOptions options,
                                                 std::vector<core::structure::ReferenceMode> check = {});

// Modal estimates of a run -> reports of what the declared structure fails to explain, at most one a period of stream
// time. Not thread-safe.
class StructureComparison {
 public:
  StructureComparison(core::structure::DeclaredFrame declared, const std::vector<core::ChannelInfo>& channels,
                      double period_s);

  [[nodiscard]] bool is_due(const core::ModalEstimate& estimate) const noexcept;
  // Takes from a second to minutes, as the structure is large. Modes that allow no comparison give a report that says
  // so. `goes_on` is called every few seconds at most; when it returns false, throws std::runtime_error.
  [[nodiscard]] core::closure::ClosureReport report(const core::ModalEstimate& estimate,
                                                    const std::function<bool()>& goes_on);

 private:
  core::structure::DeclaredFrame declared_;
  std::vector<std::string> channel_names_;
  std::int64_t period_ns_, next_ns_;
  std::uint64_t n_reports_ = 0;
};

}  // namespace app
