// hovermodal closeloop --record tracks.csv: attributes the residual of the points' positions to a missing effect.
#include "tools/hovermodal/closeloop/closeloop_tracks.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/residual_view.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/chain/observation.h"
#include "firmware_app/replay/tracks_record.h"
#include "firmware_app/report/closure_json.h"
#include "firmware_app/report/closure_modes_svg.h"
#include "firmware_app/report/closure_pictures.h"
#include "tools/hovermodal/closeloop/closing.h"
#include "tools/hovermodal/closeloop/series_modes.h"

namespace tools {
namespace {

using core::closure::ClosureResult;
using core::closure::ObservationLevel;
using core::closure::ResidualView;

ResidualView view_of(const ObservationLevel& level) {
  return core::closure::residual_view(level.state().model().residual_px(), level.state().mean_places_px(),
                                      level.state().record().rate_hz);
}

void write_pictures_of(const TracksLoop& request, const ObservationLevel& level, const ClosureResult& result,
                       const ResidualView& before) {
  const std::filesystem::path folder = request.report;
  const auto write = [&](const char* name, const std::string& text) {
    if (!text.empty()) drivers::write_file_atomically((folder / name).string(), text);
  };
  double squares = 0.0;
  for (const double sigma : level.state().record().sigma_px) squares += sigma * sigma;
  const app::ResidualPair pair{before, view_of(level), level.state().record().width_px,
                               level.state().record().height_px,
                               std::sqrt(squares / static_cast<double>(level.state().record().sigma_px.size()))};
  write("closure_field.svg", app::closure_field_svg(pair));
  write("closure_residual.svg", app::closure_residual_svg(pair));
  if (!result.reference_error_before || !result.reference_error_after) return;
  ClosureResult modes = result;  // that picture is in percent of frequency
  modes.baseline_rms = *result.reference_error_before;
  modes.residual_rms = *result.reference_error_after;
  write("closure_modes.svg", app::closure_modes_svg(modes));
}

}  // namespace

bool is_tracks_record(const std::string& path) {
  if (std::filesystem::is_directory(path)) return true;
  drivers::CsvLines file(path);
  std::string_view line;
  while (file.next(line)) {
    if (!line.starts_with('#')) return line.starts_with("frame,t_s,point,region,");
  }
  return false;
}

void close_tracks(const TracksLoop& request) {
  if (request.config.empty())
    throw std::invalid_argument("--record of tracks needs --config: the regions and the camera of that run");
  const app::AppConfig config = app::load_config(request.config, request.overrides);
  const app::TracksRecord input = app::read_tracks_record(request.record, config);
  ObservationLevel level(input.record);
  level.set_reference(read_known_modes(request.reference, level.channel_names()));
  for (const auto* list : {&input.warnings, &level.warnings()}) {
    for (const std::string& warning : *list) request.answer.note("note: {}\n", warning);
  }
  core::closure::ClosureOptions loop;
  loop.n_surrogates = request.n_surrogates > 0 ? request.n_surrogates : ObservationLevel::kSurrogates;
  loop.seed = request.seed;
  (void)level.fit();
  const ResidualView before = view_of(level);
  ClosureResult result = close_level(request.answer, level, loop);
  app::name_motors(config, {}, input.record, result);
  keep_earlier_closure(request.report);
  if (!request.report.empty()) write_pictures_of(request, level, result, before);
  show_closure(request.answer, result, "", request.report);
}

}  // namespace tools
