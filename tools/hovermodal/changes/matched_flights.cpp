#include "tools/hovermodal/changes/matched_flights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/identification/mac.h"
#include "core/linear/median.h"
#include "firmware_app/report/mode_match.h"

namespace tools {
namespace {

using core::ModePlace;
using core::monitoring::FlightSeries;
using Places = std::vector<ModePlace>;

constexpr double kContinuedMac = 0.9, kContinuedHz = 0.2;  // relative
constexpr double kLeastPart = 1.0 / 3.0;                   // of the flights
constexpr double kAlikeShape = 0.8;                        // MAC of a mode whose frequency says nothing
constexpr double kSameRatio = 0.01;                        // relative difference of the modes' ratios

class Matching {
 public:
  Matching(const std::vector<const app::ModalReport*>& reports, const core::monitoring::Conditions& conditions)
      : reports_(reports), conditions_(conditions) {}

  [[nodiscard]] MatchedFlights match() {
    for (const Places& group : joined(groups())) {
      if (static_cast<double>(group.size()) < std::max(2.0, kLeastPart * static_cast<double>(reports_.size()))) {
        ++out_.n_rare;
      } else {
        out_.modes.push_back(group);
      }
    }
    leave_out_contradictions();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const core::Mode& mode(const ModePlace& place) const {
    return reports_[place.i_estimate]->estimate.modes[place.i_mode];
  }

  [[nodiscard]] std::vector<Places> groups() const {
    std::vector<core::EstimateInput> inputs;
    for (const app::ModalReport* report : reports_) inputs.push_back({report->channel_names, &report->estimate, true});
    std::vector<Places> out;
    for (core::ModeGroup& group : core::combine_estimates(inputs)) out.push_back(std::move(group.members));
    return out;
  }

  [[nodiscard]] double mac(const ModePlace& a, const ModePlace& b) const {
    const app::ModalReport &one = *reports_[a.i_estimate], &other = *reports_[b.i_estimate];
    const auto names = app::common_channels(one, other);
    if (names.size() < 3) return 0.0;
    return core::mac(app::shape_for(one, mode(a), names), app::shape_for(other, mode(b), names));
  }

  [[nodiscard]] bool is_continued(const Places& before, const Places& after) const {
    if (before.back().i_estimate >= after.front().i_estimate) return false;
    const double one = mode(before.back()).frequency_hz, other = mode(after.front()).frequency_hz;
    return std::abs(other / one - 1.0) < kContinuedHz && mac(before.back(), after.front()) > kContinuedMac;
  }

  [[nodiscard]] std::vector<Places> joined(std::vector<Places> groups) const {
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t k = 0; k < groups.size(); ++k) {
        if (i == k || groups[i].empty() || groups[k].empty() || !is_continued(groups[i], groups[k])) continue;
        groups[i].insert(groups[i].end(), groups[k].begin(), groups[k].end());
        groups[k].clear();
      }
    }
    std::erase_if(groups, [](const Places& group) { return group.empty(); });
    return groups;
  }

  void leave_out_contradictions() {
    std::vector<FlightSeries> series;
    for (const Places& group : out_.modes) series.push_back(frequencies_of(reports_, group));
    out_.contradicting = core::monitoring::contradicting_flights(series, conditions_);
    for (std::size_t f = 0; f < reports_.size() && reports_.size() > 2; ++f) {
      if (const auto one = far_flight(f)) out_.contradicting.push_back(*one);
    }
    for (const auto& one : out_.contradicting) {
      for (Places& group : out_.modes)
        std::erase_if(group, [&](const ModePlace& place) { return place.i_estimate == one.flight; });
    }
    std::erase_if(out_.modes, [](const Places& group) { return group.empty(); });
  }

  // A flight without a mode of the others whose shapes are nevertheless theirs, all by one ratio of the frequencies: a
  // frame rate of 25 stated for 30.
  [[nodiscard]] std::optional<core::monitoring::ContradictingFlight> far_flight(std::size_t flight) const {
    std::vector<double> ratios;
    for (const Places& group : out_.modes) {
      const auto of_flight = [&](const ModePlace& place) { return place.i_estimate == flight; };
      if (std::any_of(group.begin(), group.end(), of_flight)) return std::nullopt;
      double best = kAlikeShape;
      std::optional<double> ratio;
      for (std::size_t m = 0; m < reports_[flight]->estimate.modes.size(); ++m) {
        const double alike = mac({flight, m}, group.back());
        if (alike > best) best = alike, ratio = mode({flight, m}).frequency_hz / mode(group.back()).frequency_hz;
      }
      if (ratio) ratios.push_back(*ratio);
    }
    const double middle = core::median(ratios);
    std::erase_if(ratios, [&](double one) { return std::abs(one / middle - 1.0) > kSameRatio; });
    if (ratios.size() < 2) return std::nullopt;
    return core::monitoring::ContradictingFlight{flight, middle - 1.0, kSameRatio * middle, ratios.size(), true};
  }

  const std::vector<const app::ModalReport*>& reports_;
  const core::monitoring::Conditions& conditions_;
  MatchedFlights out_;
};

}  // namespace

MatchedFlights match_flights(const std::vector<const app::ModalReport*>& reports,
                             const core::monitoring::Conditions& conditions) {
  return Matching(reports, conditions).match();
}

std::string words_of(const core::monitoring::ContradictingFlight& flight) {
  const std::string share = fmt::format("{:.2f} % +- {:.2f} % {}", 100.0 * std::abs(flight.share), 100.0 * flight.std,
                                        flight.share > 0.0 ? "higher" : "lower");
  if (!flight.is_common) return fmt::format("its modes lie {} on average", share);
  return fmt::format("all its {} modes lie {}: check its frame rate or clock", flight.n_modes, share);
}

FlightSeries frequencies_of(const std::vector<const app::ModalReport*>& reports, const Places& mode) {
  FlightSeries out;
  for (const ModePlace& place : mode) {
    const core::ModalEstimate& estimate = reports[place.i_estimate]->estimate;
    const core::Mode& one = estimate.modes[place.i_mode];
    if (one.frequency_std_hz.value_or(0.0) > 0.0)
      out.push_back({place.i_estimate, one.frequency_hz, *one.frequency_std_hz, estimate.degrees_of_freedom});
  }
  return out;
}

}  // namespace tools
