#include "tools/hovermodal/closeloop/tracks_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "drivers/storage/calibration_file.h"
#include "drivers/storage/csv.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/report/modal_json.h"

namespace tools {
namespace {

using core::closure::ObservationRecord;

constexpr std::uint64_t kMostFrames = 1'000'000;

core::CameraModel calibrated_camera(const app::AppConfig& config, const core::CameraInfo& camera,
                                    std::vector<std::string>& warnings) {
  const app::CalibrationConfig& c = config.calibration;
  if (!c.file.empty()) return drivers::read_calibration(c.file).camera;
  core::CameraModel model{c.fx, c.fy, c.cx, c.cy, c.distortion, c.model};
  if (model.calibrated()) return model;
  warnings.push_back(
      fmt::format("no calibration: the focal length is taken to be the image's width, {} px; angles and lens "
                  "coefficients are in units of that",
                  camera.width_px));
  model = {};
  model.fx = model.fy = camera.width_px;
  model.cx = 0.5 * (camera.width_px - 1), model.cy = 0.5 * (camera.height_px - 1);
  return model;
}

void declare(const drivers::TracksFile& file, const app::AppConfig& config, ObservationRecord& record) {
  const core::CameraInfo& camera = file.camera;
  record.rate_hz = config.camera.rate_hz > 0.0 ? config.camera.rate_hz : camera.rate_hz;
  record.width_px = camera.width_px, record.height_px = camera.height_px;
  const bool own = config.camera.readout_ms != 0.0;
  const double readout_s = own ? 1e-3 * config.camera.readout_ms : 1e-9 * static_cast<double>(camera.readout_ns);
  record.readout_frames = readout_s * record.rate_hz;
  record.readout_direction = own ? config.camera.readout_direction : camera.readout_direction;
  record.regions = config.regions;
}

// Columns of points in declared regions, in the order of their first appearance.
class Columns {
 public:
  Columns(const drivers::TracksFile& file, const app::AppConfig& config) {
    for (const std::string& name : file.region_names) {
      const auto found = std::find_if(config.regions.begin(), config.regions.end(),
                                      [&](const core::Region& region) { return region.name == name; });
      region_.push_back(found == config.regions.end() ? -1 : static_cast<int>(found - config.regions.begin()));
    }
    for (const core::TrackFrame& frame : file.frames) {
      for (const core::TrackPoint& p : frame.points) {
        if (region_[p.region] < 0 || !column_.emplace(p.id, region_of_point.size()).second) continue;
        region_of_point.push_back(static_cast<std::size_t>(region_[p.region]));
      }
    }
  }
  [[nodiscard]] int column(const core::TrackPoint& p) const {
    const auto found = column_.find(p.id);
    return region_[p.region] < 0 || found == column_.end() ? -1 : static_cast<int>(found->second);
  }
  std::vector<std::size_t> region_of_point;

 private:
  std::vector<int> region_;
  std::map<std::uint32_t, std::size_t> column_;
};

void fill(const drivers::TracksFile& file, const Columns& columns, const core::CameraModel& model,
          ObservationRecord& record) {
  const std::uint64_t first = file.frames.front().sequence, last = file.frames.back().sequence;
  const auto n = static_cast<Eigen::Index>(columns.region_of_point.size());
  record.region_of_point = columns.region_of_point;
  record.u_px.setConstant(static_cast<Eigen::Index>(last - first) + 1, n, std::numeric_limits<double>::quiet_NaN());
  record.v_px = record.u_px;
  std::vector<double> squares(columns.region_of_point.size(), 0.0), count = squares;
  record.raw_share.assign(columns.region_of_point.size(), std::numeric_limits<double>::quiet_NaN());
  for (const core::TrackFrame& frame : file.frames) {
    for (const core::TrackPoint& p : frame.points) {
      const int c = columns.column(p);
      if (c < 0) continue;
      const auto i = static_cast<std::size_t>(c);
      const core::Vector2 place = model.undistort({p.u_px, p.v_px});
      // One scale along both axes: what a point's place means in units of the focal length stays.
      record.u_px(static_cast<Eigen::Index>(frame.sequence - first), c) = place.u;
      record.v_px(static_cast<Eigen::Index>(frame.sequence - first), c) =
          model.cy + (place.v - model.cy) * model.fx / model.fy;
      if (std::isnan(record.raw_share[i])) record.raw_share[i] = record.readout_share(p.u_px, p.v_px);
      squares[i] += p.sigma_px * p.sigma_px, count[i] += 1.0;
    }
  }
  for (std::size_t i = 0; i < squares.size(); ++i) record.sigma_px.push_back(std::sqrt(squares[i] / count[i]));
}

}  // namespace

TracksInput read_tracks_input(const std::string& path, const app::AppConfig& config) {
  const std::string file_path =
      std::filesystem::is_directory(path) ? (std::filesystem::path(path) / "tracks.csv").string() : path;
  const drivers::TracksFile file = drivers::read_tracks_csv(file_path);
  if (file.frames.empty()) throw drivers::FileError(file_path + ": no frame with a point");
  if (file.frames.back().sequence - file.frames.front().sequence >= kMostFrames)
    throw drivers::FileError(fmt::format("{}: frame numbers run over {} frames, at most {} are taken", file_path,
                                         file.frames.back().sequence - file.frames.front().sequence + 1, kMostFrames));
  TracksInput out;
  const Columns columns(file, config);
  if (columns.region_of_point.empty())
    throw drivers::FileError(file_path + ": no point lies in a region of the configuration; is it that of the run?");
  declare(file, config, out.record);
  const core::CameraModel model = calibrated_camera(config, file.camera, out.warnings);
  out.record.alpha_px = model.fx, out.record.cx_px = model.cx, out.record.cy_px = model.cy;
  fill(file, columns, model, out.record);
  return out;
}

std::vector<core::Mode> read_known_modes(const std::string& path, const std::vector<std::string>& channels) {
  std::vector<core::Mode> out;
  if (path.empty()) return out;
  if (!path.ends_with(".json")) {
    const drivers::SeriesFile file = drivers::read_foreign_series(path);
    const int column = file.column("frequency_hz");
    if (column < 0) throw drivers::FileError(path + ": no column frequency_hz");
    for (const double hz : file.columns[static_cast<std::size_t>(column)]) {
      if (!(std::isfinite(hz) && hz > 0.0)) throw drivers::FileError(path + ": frequency_hz must be positive numbers");
      out.emplace_back().frequency_hz = hz;
    }
    return out;
  }
  const app::ModalReport report = app::read_modal_json(path);
  for (core::Mode mode : report.estimate.modes) {
    std::vector<std::complex<double>> shape;
    for (const std::string& name : channels) {
      const auto found = std::find(report.channel_names.begin(), report.channel_names.end(), name);
      const auto i = static_cast<std::size_t>(found - report.channel_names.begin());
      if (i < mode.shape.size()) shape.push_back(mode.shape[i]);
    }
    mode.shape = shape.size() == channels.size() ? std::move(shape) : std::vector<std::complex<double>>{};
    out.push_back(std::move(mode));
  }
  return out;
}

}  // namespace tools
