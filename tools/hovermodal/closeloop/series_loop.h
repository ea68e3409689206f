#pragma once

#include <string>
#include <vector>

#include "core/closure/response/response_model.h"
#include "core/types/closure_result.h"
#include "tools/hovermodal/closeloop/closeloop_series.h"

namespace tools {

// Residual diagnosis of a response model, with a limited number of surrogates per step; progress on a terminal.
[[nodiscard]] core::closure::ClosureResult close_response(const LoopRequest& request,
                                                          const core::closure::ResponseModel& model,
                                                          std::size_t most_surrogates,
                                                          std::vector<std::string>* adopted = nullptr);
// Prints the result (with --json that of closure.json alone), and writes it as a file of the report if requested.
void show_response(const LoopRequest& request, const core::closure::ClosureResult& result, const std::string& file);

// Adds the modes of both series, paired with the reference.
void add_modes(core::closure::ClosureResult& result, const app::ChannelSeries& before, const app::ChannelSeries& after,
               double max_frequency_hz, const std::string& reference_path);

// One file per logger.
void close_loggers(const LoopRequest& request, const SeriesLoop& options);
// For ambient response or a measured input.
void close_channels(const LoopRequest& request, const SeriesLoop& options, app::ChannelSeries series);

}  // namespace tools
