#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/types/modal_estimate.h"
#include "tools/validate/identification.h"
#include "tools/validate/identification_match.h"

namespace tools {

// Verdicts on motion that is no mode, and on the modes near it.

inline constexpr std::array kVerdicts{core::Verdict::kStructural,   core::Verdict::kAmbiguous,
                                      core::Verdict::kCameraMotion, core::Verdict::kInputPeak,
                                      core::Verdict::kHarmonic,     core::Verdict::kNumerical};
using VerdictCounts = std::array<int, kVerdicts.size() + 1>;  // the last: no pole

[[nodiscard]] std::size_t place_of(core::Verdict verdict);  // among them
[[nodiscard]] std::string verdict_names();
[[nodiscard]] std::string columns(const VerdictCounts& counts);
[[nodiscard]] std::vector<core::Mode> all_poles(const core::ModalEstimate& estimate);

// Of one record.
struct Judged {
  core::ModalEstimate estimate;
  Match match;
  std::vector<core::ChannelInfo> channels;
  std::vector<core::simulation::TrueMode> truth;
};
[[nodiscard]] Judged judge_record(const Record& record, double max_frequency_hz,
                                  std::vector<core::simulation::TrueMode> truth);

// Verdicts on true modes.
struct TrueModes {
  int n = 0, right = 0, called_harmonic = 0, called_camera = 0;

  void add(const Judged& record);
};

// A number between the two limits that depends on seed and name only.
[[nodiscard]] double drawn_between(std::uint64_t seed, const char* name, double low, double high);

// A line of the table: a wandering rotor line near modes.
void print_rotor(const IdentificationOptions& options, bool is_drawn, bool with_base);

}  // namespace tools
