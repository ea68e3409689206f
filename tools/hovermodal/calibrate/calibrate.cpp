// hovermodal calibrate: estimates the camera and its lens from pictures of a chessboard.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "drivers/host/command_line.h"
#include "drivers/storage/calibration_file.h"
#include "drivers/storage/json.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/earlier_files.h"
#include "tools/hovermodal/answer.h"
#include "tools/hovermodal/calibrate/board_search.h"
#include "tools/hovermodal/calibrate/calibration_words.h"
#include "tools/hovermodal/clip_source.h"
#include "tools/hovermodal/commands.h"
#include "tools/hovermodal/named_file.h"

namespace tools {
namespace {

struct Options {
  std::vector<std::string> sources;
  std::string board, model = "radtan", out, report;
  double square_mm = 0.0;
  int every = 0, views = 40, decoder_mb = drivers::kDecoderMb;
  bool force = false;
  Answer answer;
};

constexpr const char* kFooter = R"(HOW TO FILM THE BOARD
  Print a chessboard, glue it to something flat and stiff (glass, a board), and measure one square. --board counts
  the inner corners, where four squares meet: a board of 10 x 7 squares has 9x6. An odd and an even number are best.
  - Film with the mode of the flight: same resolution, zoom, stabilisation off, focus as far as the flight's if it can
    be locked. Changing any of them requires another calibration.
  - Let the board fill a third to all of the image, and bring it into every corner: where no corner of the board was
    ever seen, the distortion is extrapolated. The whole board must be visible, with a white rim.
  - Tilt it by 20 to 40 degrees to the left, right, up and down, and rotate it by 90 degrees once. Without tilt
    the focal length cannot be distinguished from the distance.
  - Good light and slow motion: hold still for a second at each of 20 to 40 places. A rolling shutter shears a board
    that moves.
  A clip of one minute is enough. The reprojection error should be 0.1 to 0.5 px.

EXAMPLE
  hovermodal calibrate board.mp4 --board 9x6 --square-mm 25 --out calibration.yaml --report calibration
  and in the configuration of the flight:  calibration: {file: calibration.yaml}

The file is in OpenCV's format. Fisheye lenses (more than about 100 degrees across) need --model equidistant.)";

core::ChessBoard parse_board(const Options& options) {
  core::ChessBoard board;
  const std::size_t x = options.board.find('x');
  const bool two = x != std::string::npos;
  const auto number = [](std::string_view text) { return drivers::parse_whole(text).value_or(0); };
  const std::int64_t columns = two ? number(std::string_view(options.board).substr(0, x)) : 0;
  const std::int64_t rows = two ? number(std::string_view(options.board).substr(x + 1)) : 0;
  if (std::min(columns, rows) < 3 || std::max(columns, rows) > 50) {
    throw std::invalid_argument(
        fmt::format("--board {}: is refused: allowed COLUMNSxROWS, each 3 .. 50; count the inner corners, e.g. 9x6",
                    drivers::printable(options.board)));
  }
  if (!(options.square_mm > 0.0 && options.square_mm <= 1e6))
    throw std::invalid_argument(fmt::format("--square-mm {}: is refused: allowed more than 0", options.square_mm));
  board.columns = static_cast<int>(columns);
  board.rows = static_cast<int>(rows);
  board.square_mm = options.square_mm;
  return board;
}

std::string none_found(const FoundBoards& found, const core::ChessBoard& board) {
  std::string text = fmt::format("the board of {}x{} inner corners was found in {} of {} images, {} are needed",
                                 board.columns, board.rows, found.views.size(), found.n_looked_at, core::kMinViews);
  if (!found.hint.empty()) return text + "; " + found.hint;
  return text + "; count the inner corners, keep the whole board with its white rim in the picture, avoid blur";
}

void keep(CalibrationRun& run, const std::vector<std::size_t>& indices) {
  std::vector<core::BoardView> views;
  std::vector<std::string> places;
  for (const std::size_t i : indices) {
    views.push_back(std::move(run.views[i]));
    places.push_back(std::move(run.places[i]));
  }
  run.views = std::move(views);
  run.places = std::move(places);
}

// Blurred or sheared boards show in their residuals: they are left out, once.
void leave_out_bad_views(CalibrationRun& run) {
  std::vector<double> sorted = run.fit.view_rms_px;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double most = std::max(0.3, 3.0 * sorted[sorted.size() / 2]);
  std::vector<std::size_t> good;
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    if (run.fit.view_rms_px[i] <= most) {
      good.push_back(i);
    } else {
      run.dropped.push_back(fmt::format("{} ({:.2f} px: blurred, or sheared by the rolling shutter)", run.places[i],
                                        run.fit.view_rms_px[i]));
    }
  }
  if (good.size() < core::kMinViews) run.dropped.clear();
  if (good.size() == run.views.size() || good.size() < core::kMinViews) return;
  keep(run, good);
}

CalibrationRun fit_run(const Options& options, const core::ChessBoard& board) {
  FoundBoards found = find_boards(options.sources, board, options.every, options.decoder_mb, options.answer.quiet);
  if (found.views.size() < core::kMinViews) throw std::runtime_error(none_found(found, board));
  CalibrationRun run{board, found.width_px,    found.height_px,    found.views, found.places,
                     {},    found.n_looked_at, found.views.size(), {}};
  keep(run, core::spread_views(board, run.views, run.width_px, run.height_px, static_cast<std::size_t>(options.views)));
  if (run.views.size() < core::kMinViews) {
    throw std::runtime_error(
        fmt::format("the board is at the same place in all {} images in which it was found; move and tilt it "
                    "between them",
                    found.views.size()));
  }
  const auto lens = options.model == "equidistant" ? core::LensModel::kEquidistant : core::LensModel::kRadialTangential;
  run.fit = core::fit_camera(board, run.views, lens, run.width_px, run.height_px);
  const std::size_t n_before = run.views.size();
  leave_out_bad_views(run);
  if (run.views.size() != n_before) run.fit = core::fit_camera(board, run.views, lens, run.width_px, run.height_px);
  return run;
}

void write_report(const std::string& folder, const CalibrationRun& run, const Answer& answer) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("--report {}: cannot be made: {}; name a folder that may be written", folder, error.message()));
  }
  app::keep_earlier(folder, "calibration", {"calibration.svg"});
  const std::filesystem::path file = std::filesystem::path(folder) / "calibration.svg";
  drivers::write_file_atomically(file.string(), calibration_svg(run));
  answer.text("{} written: where the corners lay, and their residuals\n", file.string());
}

void run(const Options& options) {
  require_free(options.out, options.force);
  const CalibrationRun run = fit_run(options, parse_board(options));
  options.answer.text("{}\n", calibration_words(run));
  if (!options.report.empty()) write_report(options.report, run, options.answer);
  const std::string fault = drivers::calibration_fault(run.fit.camera, run.width_px, run.height_px);
  if (!fault.empty()) throw std::runtime_error("the result cannot be used, nothing is written: " + fault);
  const drivers::Calibration file{run.fit.camera, run.width_px, run.height_px, run.fit.rms_px};
  drivers::write_file_atomically(
      options.out, drivers::calibration_text(file, {run.board.columns, run.board.rows, run.board.square_mm,
                                                    static_cast<int>(run.views.size()), run.fit.sigma}));
  options.answer.document(calibration_json(run, options.out));
  options.answer.text("{} written; use it as  calibration: {{file: {}}}\n", options.out, options.out);
}

}  // namespace

void add_calibrate(drivers::Command& app) {
  drivers::Command command = app.subcommand(
      "calibrate", "The camera's focal length, centre and lens distortion, from a clip or images of a chessboard");
  auto options = std::make_shared<Options>();
  command.option("sources", options->sources, "Clips, images, folders of images; all of one size")
      .required()
      .type_name("CLIP_OR_IMAGES");
  command.option("--board", options->board, "Inner corners of the board, COLUMNSxROWS, e.g. 9x6")
      .required()
      .type_name("COLUMNSxROWS");
  command.option("--square-mm", options->square_mm, "Side of a square, mm (scales nothing but the stated poses)")
      .required();
  command.option("--model", options->model, "Lens: radtan, or equidistant (fisheye)")
      .one_of({"radtan", "equidistant"})
      .show_default();
  command.option("--every", options->every, "Look at every n-th frame of a clip; 0 = about 200 frames of it")
      .range(0, 1000000)
      .show_default();
  command.option("--views", options->views, "Use at most this many views: time grows with them")
      .range(3, 500)
      .show_default();
  add_decoder_option(command, options->decoder_mb);
  command.option("--out", options->out, "File to write, YAML").required().type_name("FILE");
  command.option("--report", options->report, "Folder for calibration.svg: coverage and residuals").type_name("DIR");
  add_force_option(command, options->force);
  add_answer_options(command, options->answer, "the camera with its standard deviations and the doubts");
  command.footer(kFooter);
  command.on_run([options] { run(*options); });
}

}  // namespace tools
