#include "tools/hovermodal/simulate/files.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/simulation/channel_generator.h"
#include "core/simulation/track_generator.h"
#include "drivers/storage/csv_writer.h"
#include "tools/hovermodal/simulate/progress.h"

namespace tools {
namespace {

using core::simulation::DeliveredFrame;
using core::simulation::Scene;
using core::simulation::SceneMotion;
using drivers::append_fixed;
using drivers::append_seconds;
using drivers::append_text;

// As in the service's files, but with one more digit for pixels: noise-free tracks are compared with theory.
constexpr int kPixelDecimals = 5, kDisplacementDecimals = 6, kTruthDecimals = 9;

std::string path_in(const std::filesystem::path& folder, const char* name) { return (folder / name).string(); }

template <class... Args>
void append(fmt::memory_buffer& out, fmt::format_string<Args...> format, Args&&... args) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Args>(args)...);
}

void append_whole(fmt::memory_buffer& out, std::uint64_t number) { append_text(out, fmt::format_int(number).c_str()); }

void end_line(drivers::CsvWriter& csv) {
  csv.buffer().push_back('\n');
  if (!csv.end_line()) csv.commit();  // throws with the reason
}

// The same comment lines as the tracks.csv of a run.
void write_track_header(drivers::CsvWriter& csv, const SimulateJob& job,
                        const std::vector<core::simulation::SceneRegion>& regions) {
  const core::CameraInfo camera = job.declared_camera();
  std::string names;
  for (const auto& region : regions) names += (names.empty() ? "" : ",") + region.region.name;
  fmt::memory_buffer& out = csv.buffer();
  append(out, "# hovermodal tracks, version 1\n# image_size_px: {} x {}\n# rate_hz: {}\n", camera.width_px,
         camera.height_px, camera.rate_hz);
  append(out, "# readout_ms: {}\n# readout_direction: {}\n# exposure_ms: {}\n",
         static_cast<double>(camera.readout_ns) / 1e6, to_string(camera.readout_direction),
         static_cast<double>(camera.exposure_ns) / 1e6);
  append(out, "# frame_count: {}\n# regions: {}\nframe,t_s,point,region,u_px,v_px,sigma_px", camera.frame_count, names);
  end_line(csv);
}

// The same comment lines as the displacements.csv of a run.
void write_channel_header(drivers::CsvWriter& csv, const SimulateJob& job,
                          const std::vector<core::ChannelInfo>& channels) {
  fmt::memory_buffer& out = csv.buffer();
  append(out, "# hovermodal displacements, version 1\n# unit: mm\n# rate_hz: {}\n", job.declared_camera().rate_hz);
  for (const core::ChannelInfo& channel : channels) {
    append(out, "# row_delay_s.{}: {}\n", channel.name, channel.row_delay_s);
  }
  append(out, "frame,t_s,scale_mm_per_px");
  for (const core::ChannelInfo& channel : channels) append(out, ",{}", channel.name);
  end_line(csv);
}

void append_points(drivers::CsvWriter& csv, const core::TrackFrame& frame,
                   const std::vector<core::simulation::SceneRegion>& regions, fmt::memory_buffer& prefix) {
  prefix.clear();
  append_whole(prefix, frame.sequence);
  prefix.push_back(',');
  append_seconds(prefix, frame.t_start_ns);
  prefix.push_back(',');
  fmt::memory_buffer& out = csv.buffer();
  for (const core::TrackPoint& point : frame.points) {
    if (!point.seen) continue;
    append_text(out, {prefix.data(), prefix.size()});
    append_whole(out, point.id);
    out.push_back(',');
    append_text(out, regions[point.region].region.name);
    for (const double value : {point.u_px, point.v_px, point.sigma_px}) {
      out.push_back(',');
      append_fixed(out, value, kPixelDecimals);
    }
    end_line(csv);
  }
}

void append_sample(drivers::CsvWriter& csv, const core::DisplacementSample& sample, const std::string& scale) {
  fmt::memory_buffer& out = csv.buffer();
  append_whole(out, sample.sequence);
  out.push_back(',');
  append_seconds(out, sample.t_start_ns);
  out.push_back(',');
  append_text(out, scale);
  for (std::size_t i = 0; i < sample.value_mm.size(); ++i) {
    out.push_back(',');
    if (sample.seen[i] != 0) append_fixed(out, sample.value_mm[i], kDisplacementDecimals);
  }
  end_line(csv);
}

}  // namespace

void write_true_displacements(const std::filesystem::path& folder, const SceneMotion& motion) {
  const Scene& scene = motion.scene();
  drivers::CsvWriter csv(path_in(folder, "truth_displacements.csv"));
  fmt::memory_buffer& out = csv.buffer();
  append(out,
         "# true absolute displacement in mm in the middle of the exposure of row 0, at the true time of each picture; "
         "one that is delivered again has no second line\n# unit: mm\nframe,t_s");
  for (const auto& plate : scene.plates) append(out, ",{}", plate.name);
  end_line(csv);
  core::simulation::FrameTiming timing(scene);
  double last_s = -1.0;
  for (DeliveredFrame frame; timing.next(frame);) {
    if (frame.t_s <= last_s) continue;
    last_s = frame.t_s;
    const double t_s = frame.t_s + 0.5 * scene.camera.exposure_s;
    append_whole(out, frame.sequence);
    out.push_back(',');
    append_seconds(out, std::llround(t_s * 1e9));
    for (int body = 0; body < scene.n_bodies(); ++body) {
      out.push_back(',');
      append_fixed(out, motion.structure().displacement_mm(body, t_s), kTruthDecimals);
    }
    end_line(csv);
  }
  csv.commit();
}

void write_tracks(const std::filesystem::path& folder, const SimulateJob& job, bool is_quiet) {
  const core::simulation::TrackGenerator generator(job.scene());
  drivers::CsvWriter csv(path_in(folder, "tracks.csv"));
  write_track_header(csv, job, generator.regions());
  core::TrackFrame frame;
  fmt::memory_buffer prefix;
  Progress progress("simulate", job.scene().n_frames(), "frames", is_quiet);
  auto timing = generator.timing();
  for (DeliveredFrame delivered; timing.next(delivered);) {
    generator.generate(delivered, frame);
    append_points(csv, frame, generator.regions(), prefix);
    progress.update(delivered.number + 1);
  }
  csv.commit();
}

void write_channels(const std::filesystem::path& folder, const SimulateJob& job, const SceneMotion& motion,
                    bool is_quiet) {
  const double readout_s = 1e-9 * static_cast<double>(job.declared_camera().readout_ns);
  const core::simulation::ChannelGenerator generator(motion, readout_s);
  drivers::CsvWriter csv(path_in(folder, "displacements.csv"));
  write_channel_header(csv, job, generator.channels());
  core::DisplacementSample sample = generator.sample_prototype();
  std::string scale;
  Progress progress("simulate", job.scene().n_frames(), "frames", is_quiet);
  auto timing = generator.timing();
  for (DeliveredFrame delivered; timing.next(delivered);) {
    generator.generate(delivered, sample);
    if (scale.empty()) scale = fmt::format("{:.9g}", sample.scale_mm_per_px);
    append_sample(csv, sample, scale);
    progress.update(delivered.number + 1);
  }
  csv.commit();
}

}  // namespace tools
