#pragma once

#include <complex>
#include <string>
#include <vector>

#include "core/types/closure_result.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/replay/analysis.h"

namespace tools {

// A mode that is known from elsewhere; shape by channel name, may be empty.
struct KnownMode {
  double frequency_hz = 0.0;
  std::vector<std::string> channels;
  std::vector<std::complex<double>> shape;
};

// Of a modal.json, or of a table with a column frequency_hz; none for "". Throws drivers::FileError.
[[nodiscard]] std::vector<KnownMode> read_reference_modes(const std::string& path);

// Modes of a modal.json (structural ones, shapes in the order of `channels` where all are named) or of a table with a
// column frequency_hz. Throws drivers::FileError.
[[nodiscard]] std::vector<core::Mode> read_known_modes(const std::string& path,
                                                       const std::vector<std::string>& channels);

// The structural modes that identify finds, each beside the reference mode within 5 % of it (where shapes are known:
// of the largest MAC over the channels that both name). None, where the record is too short.
[[nodiscard]] std::vector<core::closure::ClosureMode> modes_of_series(const app::ChannelSeries& series,
                                                                      double max_frequency_hz,
                                                                      const std::vector<KnownMode>& reference);

// The identified modes before and after, where a result has such beside its own, for a terminal.
[[nodiscard]] std::string identified_text(const core::closure::ClosureResult& result);

// rms of the errors of frequency of the modes that have a reference, percent; NaN without any.
[[nodiscard]] double rms_error_percent(const std::vector<core::closure::ClosureMode>& modes);

}  // namespace tools
