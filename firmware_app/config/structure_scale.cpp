#include "firmware_app/config/structure_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/geometry/length_scale.h"

namespace app {
namespace {

using core::KnownLength;
using core::Vector2;

class ScaleReader {
 public:
  ScaleReader(const AppConfig& config, const core::CameraModel& camera)
      : config_(config), scale_(config.scale), camera_(camera) {}

  [[nodiscard]] StructureScale read() {
    take_lengths();
    if (!scale_.points.empty()) {
      take_plane();
    } else if (!all_.empty()) {
      take_common(common_.empty() ? all_ : common_);
    }
    take_regions();
    if (out_.known && !out_.plane) note_obliqueness();
    return std::move(out_);
  }

 private:
  [[nodiscard]] KnownLength known(double u1, double v1, double u2, double v2, double mm) const {
    return {seen({u1, v1}), seen({u2, v2}), mm};
  }
  [[nodiscard]] KnownLength of_region(const core::Region& r) const {
    return {seen(r.length_from_px), seen(r.length_to_px), r.length_mm};
  }
  // An image position that lies within the lens's field.
  [[nodiscard]] Vector2 seen(const Vector2& raw_px) const {
    const Vector2 ideal = camera_.undistort(raw_px);
    if (std::isfinite(ideal.u) && std::isfinite(ideal.v)) return ideal;
    throw ConfigError(fmt::format(
        "scale: the pixel [{}, {}] is refused: allowed where the lens can be undone; name a place nearer to the middle",
        raw_px.u, raw_px.v));
  }
  [[nodiscard]] Vector2 centre(const core::Region& r) const {
    return camera_.undistort({r.u_px + 0.5 * (r.width_px - 1.0), r.v_px + 0.5 * (r.height_px - 1.0)});
  }
  [[nodiscard]] static Vector2 direction(const core::Region& r) {
    const double angle = r.both_axes ? 0.0 : r.axis_deg * std::numbers::pi / 180.0;
    return {std::cos(angle), std::sin(angle)};
  }

  void take_lengths() {
    if (scale_.known_length_mm > 0.0) {
      common_.push_back(
          known(scale_.from_px[0], scale_.from_px[1], scale_.to_px[0], scale_.to_px[1], scale_.known_length_mm));
    }
    for (const auto& row : scale_.lengths) common_.push_back(known(row[0], row[1], row[2], row[3], row[4]));
    all_ = common_;
    for (const core::Region& region : config_.regions) {
      if (region.length_mm > 0.0) all_.push_back(of_region(region));
    }
  }

  void take_common(const std::vector<KnownLength>& lengths) {
    const core::LengthScale fit = core::fit_length_scale(lengths, scale_.point_sigma_px);
    if (!(fit.mm_per_px > 0.0)) return;
    out_.mm_per_px = fit.mm_per_px;
    out_.sigma = fit.sigma;
    out_.known = true;
    if (lengths.size() < 2) return;
    out_.notes.push_back(
        fmt::format("scale {:.5g} +- {:.2g} mm/px from {} lengths", fit.mm_per_px, fit.sigma, lengths.size()));
    // Three standard deviations per degree of freedom: a larger misfit cannot be explained by reading errors.
    if (fit.chi_square > 9.0 * static_cast<double>(lengths.size() - 1)) {
      out_.notes.push_back(
          fmt::format("the lengths disagree: number {} gives a scale {:+.1f} % different from the others; is it in "
                      "the structure's plane, or is the view oblique? scale.points or a length per region would "
                      "correct that",
                      fit.worst + 1, 100.0 * fit.worst_share));
    }
  }

  [[nodiscard]] core::PlanePoseFit fit_plane(std::span<const core::PlaneCorrespondence> points) const {
    const core::PlanePoseFit fit = core::fit_plane_pose(points, camera_, scale_.point_sigma_px);
    const auto refuse = [](const std::string& why) {
      throw ConfigError("scale.points: are refused: allowed 4 or more points of one plane; " + why);
    };
    switch (fit.status) {
      case core::PlaneStatus::kNotCalibrated:
        refuse("they need a calibration: give calibration.file, or scale.lengths in their place");
        break;
      case core::PlaneStatus::kTooFew:
      case core::PlaneStatus::kCollinear:
        refuse("they lie on one line, or three of four do: add a point well away from it");
        break;
      case core::PlaneStatus::kNoFit:
        refuse("no plane in front of the camera shows them there: check pixels and millimetres");
        break;
      case core::PlaneStatus::kOk:
        break;
    }
    if (fit.pose.rms_px > std::max(3.0, 6.0 * scale_.point_sigma_px)) {
      std::size_t worst = 0;
      double worst_px = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector2 at = fit.pose.project(points[i].place).value_or(points[i].ideal_px);
        const double error_px = std::hypot(at.u - points[i].ideal_px.u, at.v - points[i].ideal_px.v);
        if (error_px > worst_px) worst = i, worst_px = error_px;
      }
      refuse(
          fmt::format("they contradict each other by {:.1f} px rms, number {} most ({:.1f} px): check its pixels and "
                      "millimetres, or raise scale.point_sigma_px",
                      fit.pose.rms_px, worst + 1, worst_px));
    }
    return fit;
  }

  void take_plane() {
    std::vector<core::PlaneCorrespondence> points;
    for (const auto& row : scale_.points) points.push_back({seen({row[0], row[1]}), {row[2], row[3]}});
    const core::PlanePoseFit fit = fit_plane(points);
    out_.plane = fit.pose;
    out_.known = true;
    core::PlanePlace middle;
    for (const core::PlaneCorrespondence& p : points) {
      middle.x_mm += p.place.x_mm / static_cast<double>(points.size());
      middle.y_mm += p.place.y_mm / static_cast<double>(points.size());
    }
    out_.mm_per_px = fit.pose.mm_per_px(middle, {1.0, 0.0});
    out_.notes.push_back(fmt::format(
        "pose of the structure's plane from {} points ({:.2f} px rms): {:.1f} +- {:.1f} degrees off the image plane, "
        "{:.3g} m away; every region has its own scale",
        points.size(), fit.pose.rms_px, fit.pose.obliqueness_deg(), fit.pose.obliqueness_sigma_deg(),
        1e-3 * fit.pose.distance_mm()));
    if (fit.other) {
      out_.notes.push_back(
          fmt::format("the points do not exclude a plane tilted the other way ({:.1f} degrees); at this distance "
                      "both appear alike, and their scales nearly agree",
                      fit.other->obliqueness_deg()));
    }
  }

  void take_regions() {
    for (const core::Region& region : config_.regions) {
      double mm_per_px = out_.mm_per_px;
      if (out_.plane) {
        const auto place = out_.plane->place_at(centre(region));
        if (!place) {
          throw ConfigError(
              fmt::format("scale.points: region `{}` is beyond the horizon of their plane; check the points, or move "
                          "the region",
                          region.name));
        }
        mm_per_px = out_.plane->mm_per_px(*place, direction(region));
      }
      if (region.length_mm > 0.0) {
        const KnownLength own = of_region(region);
        mm_per_px = core::fit_length_scale({&own, 1}, scale_.point_sigma_px).mm_per_px;
      }
      out_.region_mm_per_px.push_back(mm_per_px);
    }
  }

  void note_obliqueness() {
    std::vector<core::ScaledPlace> places;
    for (const core::Region& region : config_.regions) {
      if (region.role != core::RegionRole::kBackground) places.push_back({centre(region), direction(region)});
    }
    const core::ObliquenessBound bound =
        core::unexcluded_obliqueness(all_, places, camera_, scale_.point_sigma_px, scale_.max_obliqueness_deg);
    if (bound.places.empty()) {
      out_.notes.emplace_back(
          "the obliqueness of the structure's plane is unknown, and without a calibration so is its "
          "effect on the scale of each region");
      return;
    }
    double low = 1.0, high = 1.0;
    for (const auto& range : bound.places) low = std::min(low, range.low), high = std::max(high, range.high);
    std::string text = fmt::format(
        "the known lengths do not exclude a structure that is {} {:.0f} degrees off the image plane: "
        "true scales of {:.3f} .. {:.3f} of the stated one, and up to {:.1f} % between regions",
        bound.least_deg > 0.0 ? fmt::format("{:.0f} to", bound.least_deg) : std::string("up to"), bound.largest_deg,
        low, high, 100.0 * (bound.between - 1.0));
    if (bound.largest_deg >= scale_.max_obliqueness_deg) text += " (more was not tried: scale.max_obliqueness_deg)";
    out_.notes.push_back(text + "; scale.points would determine it");
  }

  const AppConfig& config_;
  const ScaleConfig& scale_;
  const core::CameraModel& camera_;
  std::vector<KnownLength> common_, all_;  // without and with the lengths at regions
  StructureScale out_;
};

}  // namespace

StructureScale structure_scale(const AppConfig& config, const core::CameraModel& camera) {
  return ScaleReader(config, camera).read();
}

}  // namespace app
