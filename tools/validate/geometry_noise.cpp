// Residual motion of a static structure under a hovering camera, compared with the least that any estimator can reach.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tools/validate/geometry.h"
#include "tools/validate/geometry_flight.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

constexpr double kAboveHover_hz = 6.0;  // the recording has nothing above 5 Hz

// Sums of one channel.
struct Moments {
  double n = 0.0, sum = 0.0, squares = 0.0;
  void add(double value) { n += 1.0, sum += value, squares += value * value; }
  [[nodiscard]] double deviation() const {
    return n > 1.0 ? std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n))) : 0.0;
  }
};

// White noise with the mean density above the hover's band: its rms over the whole band.
double white_rms_mm(const core::CpsdSums& sums, int channel) {
  const auto pairs = static_cast<std::size_t>(sums.n_pairs());
  const auto pair = static_cast<std::size_t>(core::CpsdSums::pair_index(channel, channel, sums.n_channels));
  double power = 0.0, bins = 0.0;
  for (int k = 0; k < sums.n_bins(); ++k) {
    if (k * sums.rate_hz / sums.n_fft < kAboveHover_hz) continue;
    power += sums.data_sum[static_cast<std::size_t>(k) * pairs + pair].real();
    bins += 1.0;
  }
  const double segments = static_cast<double>(sums.n_segments);
  return bins > 0.0 && segments > 0.0 ? std::sqrt(power / bins / (segments * sums.window_power)) : 0.0;
}

struct Place {
  double u_px, v_px, depth_mm;
};

// Image motion of a static point, for a small camera motion (t / mm, w / rad), px per unit; along u and v.
Eigen::Matrix<double, 2, 6> camera_field(const core::simulation::CameraParameters& camera, const Place& place) {
  const double x = (place.u_px - camera.cx_px) / camera.alpha_px, y = (place.v_px - camera.cy_px) / camera.alpha_px;
  const double z = place.depth_mm;
  Eigen::Matrix<double, 2, 6> field;
  field << -1.0 / z, 0.0, x / z, x * y, -(1.0 + x * x), y,  //
      0.0, -1.0 / z, y / z, 1.0 + y * y, -x * y, -x;
  return camera.alpha_px * field;
}

// Cramer-Rao bounds of one sample of each channel, px, for points of sigma each, known, with weights w = 1 / sigma^2:
//   camera known:      1 / sqrt(sum w) over the channel's points
//   camera estimated:  sqrt(1 / sum w + h F^-1 h'), F = sum w A'A over the points of static regions (background,
//   ground), h the weighted mean of the channel's own rows of A along its axis (for the ground itself no smaller than
//   the first: as if it were not used twice); depths known.
struct Bounds {
  std::vector<double> known_px, estimated_px;
};

Bounds bounds_of(const core::simulation::TrackGenerator& generator) {
  const auto& scene = generator.motion().scene();
  core::TrackFrame frame;
  generator.generate_true({}, frame);
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<Eigen::Matrix<double, 1, 6>> rows;
  std::vector<double> weights;
  for (std::size_t r = 0; r < generator.regions().size(); ++r) rows.emplace_back(Eigen::Matrix<double, 1, 6>::Zero());
  weights.assign(rows.size(), 0.0);
  for (const core::TrackPoint& point : frame.points) {
    const auto& region = generator.regions()[point.region];
    const auto field = camera_field(scene.camera, {point.u_px, point.v_px, generator.motion().depth_mm(region.body)});
    const double weight = std::pow(generator.points()[point.id].noise_px, -2);
    if (region.body <= 0) information += weight * field.transpose() * field;
    rows[point.region] += weight * field.row(0);
    weights[point.region] += weight;
  }
  // Scaled by the units: translations in mm, rotations in rad.
  const Eigen::Matrix<double, 6, 1> unit = information.diagonal().cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
  const Eigen::Matrix<double, 6, 6> scaled = unit.asDiagonal() * information * unit.asDiagonal();
  const Eigen::Matrix<double, 6, 6> covariance =
      unit.asDiagonal() * scaled.completeOrthogonalDecomposition().pseudoInverse() * unit.asDiagonal();
  Bounds out;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double own = weights[r] > 0.0 ? 1.0 / weights[r] : 0.0;
    const Eigen::Matrix<double, 1, 6> mean = rows[r] * own;
    out.known_px.push_back(std::sqrt(own));
    out.estimated_px.push_back(std::sqrt(own + (mean * covariance * mean.transpose()).value()));
  }
  return out;
}

// Of one record: [way][channel].
struct Floors {
  std::vector<std::vector<double>> whole_mm, white_mm;
  std::vector<std::string> names;  // floors first, then the base, which not every way has
  Bounds bounds;
  double mm_per_px = 1.0;
};

Floors floors_of(const FlightSetup& setup, const std::vector<Way>& ways, std::uint64_t seed,
                 const GeometryOptions& options) {
  const SimulateJob job = flight_job(setup, seed, 300.0, options);
  std::vector<std::vector<Moments>> moments(ways.size());
  const AnalysedFlight result = analyse_flight(job, setup, ways, [&](std::size_t w, const auto& sample, const auto&) {
    moments[w].resize(sample.value_mm.size());
    for (std::size_t c = 0; c < sample.value_mm.size(); ++c) {
      if (sample.seen[c] != 0) moments[w][c].add(sample.value_mm[c]);
    }
  });
  Floors out;
  out.bounds = bounds_of(core::simulation::TrackGenerator(job.scene()));
  out.mm_per_px = job.scene().plates[0].z_mm / job.scene().camera.alpha_px;
  for (const core::ChannelInfo& channel : result.ways.back().channels) out.names.push_back(channel.name);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    out.whole_mm.emplace_back();
    out.white_mm.emplace_back();
    for (std::size_t c = 0; c < result.ways[w].channels.size(); ++c) {
      out.whole_mm[w].push_back(moments[w][c].deviation());
      out.white_mm[w].push_back(white_rms_mm(result.ways[w].sums, static_cast<int>(c)));
    }
  }
  return out;
}

// Medians over records and channels: of one channel, or of all if records differ in their channels.
class Row {
 public:
  void add(const Floors& record, std::size_t way, std::size_t channel) {
    whole_.push_back(record.whole_mm[way][channel]);
    white_.push_back(record.white_mm[way][channel]);
    known_.push_back(record.bounds.known_px[channel]);
    estimated_.push_back(record.bounds.estimated_px[channel]);
    scale_.push_back(record.mm_per_px);
  }
  void print(const std::string& figure, const std::string& way, const std::string& channel) const {
    fmt::print("{}\t{}\t{}\t{}", figure, way, channel, scale_.size());
    print_pair(whole_, false);
    print_pair(white_, false);
    print_pair(known_, true);
    print_pair(estimated_, true);
    std::vector<double> whole, white;
    for (std::size_t i = 0; i < scale_.size(); ++i) {
      whole.push_back(whole_[i] / scale_[i] / estimated_[i]);
      white.push_back(white_[i] / scale_[i] / estimated_[i]);
    }
    fmt::print("\t{:.2f}\t{:.2f}\n", statistics(whole).median, statistics(white).median);
  }

 private:
  // In the row's own unit, then in the other.
  void print_pair(std::vector<double> values, bool is_px) const {
    const double own = statistics(values).median;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] *= is_px ? scale_[i] : 1.0 / scale_[i];
    fmt::print("\t{:.5f}\t{:.5f}", own, statistics(values).median);
  }

  std::vector<double> whole_, white_, known_, estimated_, scale_;
};

}  // namespace

void print_noise_floor(const GeometryOptions& options) {
  FlightSetup setup{
      "preset: paper\ncamera: {readout_ms: 28}\nexcitation: {rms_mm: 0}\nhover: {x_rms_mm: 0, y_rms_mm: 0, z_rms_mm: "
      "0, "
      "pitch_rms_deg: 0.022, yaw_rms_deg: 0.022, roll_rms_deg: 0.022}\n",
      {"spectrum.segment=1024", "identification.period=10000"},
      0.25,
      true};
  if (options.is_drawn) setup.drawn = DrawnFlight{};
  const std::vector<Way> ways{{"ours"},
                              {"whole-motion", {"scale.only=false"}},
                              {"ours-no-background", {}, StatedReadout::kTrue, false},
                              {"paper", {"method=paper"}}};
  const auto records =
      for_each_seed(options, [&](std::uint64_t seed) { return floors_of(setup, ways, seed, options); });
  fmt::print(
      "# noise-floor: way, channel, records; medians over the records of: rms of the displacement about its mean, mm,\n"
      "#   px; rms of white noise with its density above {} Hz, mm, px; Cramer-Rao bound with the camera known, px, "
      "mm,\n"
      "#   and with the camera estimated from background and ground, px, mm; whole rms and white rms over that bound\n",
      kAboveHover_hz);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    if (options.is_drawn) {
      Row all;
      for (const Floors& record : records) {
        for (std::size_t c = 0; c < record.whole_mm[w].size(); ++c) all.add(record, w, c);
      }
      all.print("noise-floor-drawn", ways[w].name, "all");
      continue;
    }
    for (std::size_t c = 0; c < records.front().whole_mm[w].size(); ++c) {
      Row channel;
      for (const Floors& record : records) channel.add(record, w, c);
      channel.print("noise-floor", ways[w].name, records.front().names[c]);
    }
  }
}

}  // namespace tools
