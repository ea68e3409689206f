#include "firmware_app/chain/missing_effect_search.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/observation_level.h"
#include "core/tracking/similarity.h"
#include "firmware_app/chain/observation.h"
#include "firmware_app/config/core_config.h"
#include "rt/clock.h"

namespace app {

MissingEffectSearchConfig missing_effect_search_config(const AppConfig& config, const core::CameraInfo& camera,
                                                       const core::TrackFrame& keyframe) {
  const DeclaredObservation declared = declared_observation(config, camera);
  ObservedPoints points = observed_points(keyframe, config.regions.size(), config.closure.points_per_region);
  std::vector<core::Vector2> keyframe_px;
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    const core::TrackPoint& p = keyframe.points[i];
    if (points.column_of_point[i] >= 0) keyframe_px.push_back(declared.camera.undistort({p.u_px, p.v_px}));
  }
  const double rate_hz = declared.record.rate_hz;
  const bool looks = config.closure.adopt != ClosureAdopt::kOff;
  const auto n_frames = static_cast<std::size_t>(looks ? std::max(1.0, config.closure.window_s * rate_hz) : 1.0);
  return {{declared.record, declared.camera, std::move(points.region_of_column), n_frames},
          declared.camera,
          std::move(points.column_of_point),
          std::move(keyframe_px),
          rate_hz,
          config.closure.period_s,
          std::min(config.closure.delay_s, config.closure.period_s),
          config.closure.adopt == ClosureAdopt::kAuto,
          config.closure.least_px,
          motor_lines(config),
          camera.frame_count};
}

void MissingEffectSearch::take(const core::TrackFrame& frame) noexcept {
  if (!config_.recent.begin_frame(frame.sequence)) return;
  if (!has_frames_) first_unreported_ = frame.sequence;
  has_frames_ = true;
  t_last_ns_ = frame.t_start_ns;
  for (std::size_t i = 0; i < frame.points.size() && i < config_.column_of_point.size(); ++i) {
    const core::TrackPoint& point = frame.points[i];
    const int column = config_.column_of_point[i];
    if (column < 0 || !point.seen || !std::isfinite(point.u_px) || !std::isfinite(point.v_px)) continue;
    config_.recent.place(static_cast<std::size_t>(column), point);
  }
}

bool MissingEffectSearch::reaches(double periods) const noexcept {
  const std::uint64_t next = config_.recent.last_sequence() + 1;
  return has_frames_ && next > first_unreported_ &&
         static_cast<double>(next - first_unreported_) >= periods * config_.period_s * config_.rate_hz;
}

std::uint64_t MissingEffectSearch::next_report_at() const noexcept {
  const double frames = std::ceil(config_.period_s * config_.rate_hz);
  return first_unreported_ + static_cast<std::uint64_t>(std::max(1.0, frames)) - 1;
}

std::uint64_t MissingEffectSearch::n_delay_frames() const noexcept {
  return static_cast<std::uint64_t>(std::ceil(config_.delay_s * config_.rate_hz));
}

core::closure::ClosureReport MissingEffectSearch::report(bool final) {
  const core::closure::RecentTracks& recent = config_.recent;
  first_unreported_ = recent.last_sequence() + 1;
  is_reported_ = true;
  has_changed_ = false;
  core::closure::ClosureReport out;
  out.number = n_reports_++;
  out.first_sequence = recent.first_sequence();
  out.last_sequence = recent.last_sequence();
  out.t_stream_ns = t_last_ns_;
  out.duration_s = static_cast<double>(recent.n_frames()) / config_.rate_hz;
  out.final = final;
  conclude(out);
  if (!config_.adopts) return out;
  changes_from_ = first_unreported_ + n_delay_frames();
  const bool ends_before = config_.n_frames > 0 && changes_from_ >= config_.n_frames;
  const std::size_t n_in_force_before = adoption_.in_force().size();
  note_absent(out);
  if (!final && !ends_before) out.changes = adoption_.update(out, changes_from_);
  applies_since_ = since(out, n_in_force_before);
  out.in_force = adoption_.words();
  has_changed_ = !out.changes.empty();
  return out;
}

void MissingEffectSearch::note_absent(const core::closure::ClosureReport& report) {
  if (!report.refused.empty()) return;
  const auto has = [](const auto& list, const core::closure::EffectId& id) {
    return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.id == id; });
  };
  for (const core::closure::ClosureStep& step : report.result.steps) {
    if (!has(absences_, step.id)) absences_.push_back({step.id, reported_through_});
  }
  reported_through_ = report.last_sequence + 1;
  for (Absence& absence : absences_) {
    if (!has(report.result.steps, absence.id)) absence.through = reported_through_;
  }
}

// The first frame that every change of the last report concerns: an effect began after the last report without it; one
// that is withdrawn was gone when this report's frames began.
std::uint64_t MissingEffectSearch::since(const core::closure::ClosureReport& report,
                                         std::size_t n_in_force_before) const {
  std::uint64_t out = 0;
  std::size_t n_new = 0;
  for (const core::closure::EffectInForce& effect : adoption_.in_force()) {
    if (effect.from_sequence != changes_from_) continue;
    ++n_new;
    for (const Absence& absence : absences_) {
      if (absence.id == effect.id) out = std::max(out, absence.through);
    }
  }
  const bool withdraws = adoption_.in_force().size() < n_in_force_before + n_new;
  return withdraws ? std::max(out, report.first_sequence) : out;
}

std::optional<CorrectionSet> MissingEffectSearch::correction_set() const {
  if (!has_changed_) return std::nullopt;
  CorrectionSet out;
  out.from_sequence = changes_from_, out.since_sequence = applies_since_;
  const core::closure::RunCorrection correction = adoption_.correction(config_.camera);
  out.places = correction.places;
  if (out.places.lens.calibrated()) out.places.in_keyframe = lens_in_keyframe(out.places.lens);
  out.added_readout_frames = correction.added_readout.value;
  out.readout_sigma_frames = correction.added_readout.sigma.value_or(0.0);
  out.begins_record = adoption_.changes_delays();
  out.words = adoption_.words();
  return out;
}

// Whether the keyframe undistorted by the lens, or the one as it is, is closer to the present positions of the points.
bool MissingEffectSearch::lens_in_keyframe(const core::CameraModel& lens) const {
  const core::closure::ObservationRecord record = config_.recent.record();
  const std::size_t n = config_.keyframe_px.size();
  std::vector<core::Vector2> now(n), bent(n);
  for (std::size_t j = 0; j < n; ++j) {
    core::Vector2 sum;
    double count = 0.0;
    for (Eigen::Index k = 0; k < record.n_frames(); ++k) {
      const double u = record.u_px(k, static_cast<Eigen::Index>(j)), v = record.v_px(k, static_cast<Eigen::Index>(j));
      if (std::isfinite(u) && std::isfinite(v)) sum = {sum.u + u, sum.v + v}, count += 1.0;
    }
    now[j] = lens.undistort({sum.u / count, sum.v / count});  // NaN for a point that was not seen
    bent[j] = lens.undistort(config_.keyframe_px[j]);
  }
  // Region by region, because regions move and lie at several depths.
  const auto rest = [&](const std::vector<core::Vector2>& keyframe) {
    double squares = 0.0;
    for (std::size_t r = 0; r < record.regions.size(); ++r) {
      const auto counts = [&](std::size_t j) {
        return record.region_of_point[j] == r && std::isfinite(now[j].u + now[j].v + bent[j].u + bent[j].v);
      };
      const core::SimilarityMoments m = core::similarity_moments(
          0, n, counts, [&](std::size_t j) { return keyframe[j]; }, [&](std::size_t j) { return now[j]; });
      if (m.spread > 0.0) squares += m.squares - (m.along * m.along + m.across * m.across) / m.spread;
    }
    return squares;
  };
  return rest(bent) <= rest(config_.keyframe_px);
}

void MissingEffectSearch::conclude(core::closure::ClosureReport& out) const {
  const std::int64_t begin_ns = rt::monotonic_ns();
  try {
    core::closure::ObservationLevel level(config_.recent.record());
    core::closure::ClosureOptions options;
    options.n_surrogates = core::closure::ObservationLevel::kSurrogates;
    options.least_gain = config_.least_px;
    out.result = core::closure::close_loop(level, options);
    config_.motors.name(out.result, config_.rate_hz, out.duration_s);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {  // the record cannot be analysed: the report states why
    out.refused = e.what();
  }
  out.took_s = 1e-9 * static_cast<double>(rt::monotonic_ns() - begin_ns);
}

}  // namespace app
