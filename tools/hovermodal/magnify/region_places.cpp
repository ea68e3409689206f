#include "tools/hovermodal/magnify/region_places.h"

#include <algorithm>

namespace tools {

RegionPlaces::RegionPlaces(const std::string& tracks_csv, const std::vector<std::string>& names)
    : file_(drivers::read_tracks_csv(tracks_csv)), pass_(file_), shift_(names.size()) {
  for (const std::string& region : file_.region_names) {
    const auto at = std::find(names.begin(), names.end(), region);
    asked_.push_back(at == names.end() ? -1 : static_cast<int>(at - names.begin()));
  }
  for (const core::TrackPoint& point : file_.first.points) first_[point.id] = {point.u_px, point.v_px};
  has_next_ = pass_.next(next_);
}

bool RegionPlaces::advance(std::uint64_t sequence) {
  if (sequence > file_.last_sequence) return false;
  while (has_next_ && next_.sequence <= sequence) {
    take(next_);
    has_next_ = pass_.next(next_);
  }
  return true;
}

void RegionPlaces::take(const core::TrackFrame& frame) {
  std::vector<core::Vector2> sum(shift_.size());
  std::vector<double> n(shift_.size(), 0.0);
  for (const core::TrackPoint& point : frame.points) {
    const int asked = asked_.at(point.region);
    const auto first = first_.find(point.id);
    if (asked < 0 || first == first_.end()) continue;
    const auto i = static_cast<std::size_t>(asked);
    sum[i].u += point.u_px - first->second.u, sum[i].v += point.v_px - first->second.v, n[i] += 1.0;
  }
  for (std::size_t i = 0; i < shift_.size(); ++i) {
    if (n[i] > 0.0) shift_[i] = {sum[i].u / n[i], sum[i].v / n[i]};
  }
  // A point that was found later: where it would have been in the first frame.
  for (const core::TrackPoint& point : frame.points) {
    const int asked = asked_.at(point.region);
    if (asked < 0) continue;
    const core::Vector2& shift = shift_[static_cast<std::size_t>(asked)];
    first_.try_emplace(point.id, core::Vector2{point.u_px - shift.u, point.v_px - shift.v});
  }
}

}  // namespace tools
