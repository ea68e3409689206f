#include <cmath>
#include <stdexcept>

#include "drivers/exchange/series_file.h"
#include "drivers/storage/attitude_file.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/timed_columns.h"
#include "drivers/storage/tracks_file.h"
#include "tests/fuzz/memory_file.h"

namespace tests::fuzz {
namespace {

void check(const drivers::SeriesFile& series) {
  require(series.names.size() == series.columns.size() && !series.names.empty(), "a name for each column");
  for (const auto& column : series.columns) {
    require(column.size() == series.columns.front().size(), "columns are equally long");
    for (const double value : column) require(!std::isinf(value), "infinities count as missing");
  }
}

void check(const drivers::TracksFile& tracks) {
  require(tracks.camera.rate_hz > 0.0 && tracks.camera.width_px > 0 && tracks.camera.height_px > 0, "of a camera");
  drivers::TracksPass pass(tracks);
  std::uint64_t n_frames = 0;
  std::int64_t last_ns = 0;
  for (core::TrackFrame frame; pass.next(frame); last_ns = frame.t_start_ns) {
    require(n_frames++ == 0 || frame.t_start_ns > last_ns, "times increase");
    for (const core::TrackPoint& point : frame.points)
      require(point.region < tracks.region_names.size(), "a point's region has a name");
  }
  require(n_frames == tracks.n_frames, "the second pass has the same frames");
}

void check_columns(const std::string& path) {
  drivers::TimedColumnsWish wish;
  wish.time = {{"time", "t_s"}, "times"};
  wish.columns = {{{"a"}, "first", 360.0}, {{"b"}, "second"}};
  wish.to_s = 10.0;
  const drivers::TimedColumns columns = drivers::read_timed_columns(path, wish);
  require(columns.columns.size() == 2 && columns.columns[0].size() == columns.columns[1].size(), "equally long");
  require(std::isfinite(columns.rate_hz) && columns.rate_hz > 0.0, "the rate is one");
}

// The first byte selects the reader of the rest: s series, f formats of other programs, n the same without names, t
// tracks, a attitude, c columns with a time column, u universal files, m MAT files (of other bytes a refusal is
// expected).
void run(Bytes bytes) {
  Input input(bytes);
  const std::uint8_t reader = input.byte();
  const MemoryFile file(input.rest());
  try {
    if (reader == 's') check(drivers::read_series_csv(file.path()));
    if (reader == 'f' || reader == 'n') check(drivers::read_foreign_series(file.path(), {.no_names = reader == 'n'}));
    if (reader == 't') check(drivers::read_tracks_csv(file.path()));
    if (reader == 'a') require(drivers::read_attitude_csv(file.path()).size() >= 2, "two attitudes at least");
    if (reader == 'c') check_columns(file.path());
    if (reader == 'u') check(drivers::read_uff_series(file.path()));
    if (reader == 'm') check(drivers::read_mat_series(file.path()));
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

const Registration kTarget("series", &run);

}  // namespace
}  // namespace tests::fuzz
