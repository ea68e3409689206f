#pragma once

#include <complex>
#include <string>
#include <vector>

#include "core/types/closure_result.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/replay/analysis.h"

namespace tools {

// A mode known from another source; shape by channel name, may be empty.
struct KnownMode {
  double frequency_hz = 0.0;
  std::vector<std::string> channels;
  std::vector<std::complex<double>> shape;
};

// From a modal.json, or a table with a column frequency_hz; none for "". Throws drivers::FileError.
[[nodiscard]] std::vector<KnownMode> read_reference_modes(const std::string& path);

// Modes from a modal.json (structural ones, shapes in the order of `channels` if all are named) or from a table with a
// column frequency_hz. Throws drivers::FileError.
[[nodiscard]] std::vector<core::Mode> read_known_modes(const std::string& path,
                                                       const std::vector<std::string>& channels);

// The structural modes that identify finds, each paired with the reference mode within 5 % (if shapes are known: the
// one with the largest MAC over the channels named by both). Empty if the record is too short.
[[nodiscard]] std::vector<core::closure::ClosureMode> modes_of_series(const app::ChannelSeries& series,
                                                                      double max_frequency_hz,
                                                                      const std::vector<KnownMode>& reference);

// The identified modes before and after, if a result has these in addition to its own, for a terminal.
[[nodiscard]] std::string identified_text(const core::closure::ClosureResult& result);

// rms of the errors of frequency of the modes that have a reference, percent; NaN without any.
[[nodiscard]] double rms_error_percent(const std::vector<core::closure::ClosureMode>& modes);

}  // namespace tools
