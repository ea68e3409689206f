#include "tools/hovermodal/changes/mode_histories.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/median.h"
#include "tools/hovermodal/changes/matched_flights.h"

namespace tools {
namespace {

using core::ModePlace;
using core::monitoring::FlightSeries;
using Places = std::vector<ModePlace>;

constexpr double kLeastShapeStd = 0.5;  // of the typical component's

class Histories {
 public:
  explicit Histories(std::vector<DatedFlight> flights) { out_.flights = std::move(flights); }

  [[nodiscard]] ModeHistories find() {
    note_conditions();
    std::vector<const app::ModalReport*> reports;
    for (const DatedFlight& flight : out_.flights) reports.push_back(&flight.report);
    MatchedFlights matched = match_flights(reports, conditions_);
    out_.n_rare = matched.n_rare;
    out_.contradicting = std::move(matched.contradicting);
    for (const Places& group : matched.modes) {
      out_.modes.push_back(history_of(group));
      out_.modes.back().frequency.values = frequencies_of(reports, group);
    }
    test();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const core::ModalEstimate& estimate(const ModePlace& place) const {
    return out_.flights[place.i_estimate].report.estimate;
  }
  [[nodiscard]] const core::Mode& mode(const ModePlace& place) const { return estimate(place).modes[place.i_mode]; }

  [[nodiscard]] FlightSeries log_dampings(const Places& group) const {
    FlightSeries out;
    for (const ModePlace& place : group) {
      const core::Mode& one = mode(place);
      if (one.damping_ratio > 0.0 && one.damping_std.value_or(0.0) > 0.0) {
        out.push_back({place.i_estimate, std::log(one.damping_ratio), *one.damping_std / one.damping_ratio,
                       estimate(place).degrees_of_freedom});
      }
    }
    return out;
  }

  [[nodiscard]] std::vector<std::string> channels_of_all(const Places& group) const {
    std::vector<std::string> names = out_.flights[group.front().i_estimate].report.channel_names;
    for (const ModePlace& place : group) {
      const app::ModalReport& report = out_.flights[place.i_estimate].report;
      std::erase_if(names, [&](const std::string& name) {
        const auto at = std::find(report.channel_names.begin(), report.channel_names.end(), name);
        const auto c = static_cast<std::size_t>(at - report.channel_names.begin());
        return at == report.channel_names.end() || c >= mode(place).shape_std.size() ||
               (c < report.estimate.channels.size() && !report.estimate.channels[c].takes_part);
      });
    }
    return names;
  }

  // Of one mode: a shape's real parts and their standard deviations, for the channels of `names`.
  struct Shape {
    std::vector<double> value, std;
  };
  [[nodiscard]] Shape shape_of(const ModePlace& place, const std::vector<std::string>& names) const {
    const app::ModalReport& report = out_.flights[place.i_estimate].report;
    Shape out;
    for (const std::string& name : names) {
      const auto at = std::find(report.channel_names.begin(), report.channel_names.end(), name);
      const auto c = static_cast<std::size_t>(at - report.channel_names.begin());
      out.value.push_back(mode(place).shape[c].real());
      out.std.push_back(mode(place).shape_std[c]);
    }
    // The largest component is 1 by definition and has the error of the others.
    const auto largest = std::max_element(out.value.begin(), out.value.end(),
                                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    out.std[static_cast<std::size_t>(largest - out.value.begin())] = 0.0;
    const double typical = core::median(out.std);
    for (double& std : out.std) std = std::max(std, kLeastShapeStd * typical);
    return out;
  }

  static void scale_to(const std::vector<double>& mean, Shape& shape) {
    double own = 0.0, both = 0.0;
    for (std::size_t c = 0; c < mean.size(); ++c) both += shape.value[c] * mean[c], own += mean[c] * mean[c];
    if (both == 0.0) return;
    for (std::size_t c = 0; c < mean.size(); ++c) shape.value[c] *= own / both, shape.std[c] *= std::abs(own / both);
  }

  void add_shape(const Places& group, ModeHistory& out) const {
    const std::vector<std::string> names = channels_of_all(group);
    if (names.size() < 2) return;
    std::vector<Shape> shapes;
    for (const ModePlace& place : group) shapes.push_back(shape_of(place, names));
    std::vector<double> mean = shapes.front().value;
    for (int round = 0; round < 2; ++round) {
      std::vector<double> sum(names.size(), 0.0);
      for (Shape& shape : shapes) {
        scale_to(mean, shape);
        for (std::size_t c = 0; c < names.size(); ++c) sum[c] += shape.value[c] / static_cast<double>(shapes.size());
      }
      mean = sum;
    }
    for (std::size_t c = 0; c < names.size(); ++c) {
      ModeHistory::Component& component = out.shape.emplace_back();
      component.channel = names[c];
      for (std::size_t k = 0; k < group.size(); ++k) {
        if (shapes[k].std[c] > 0.0) {
          component.value.values.push_back(
              {group[k].i_estimate, shapes[k].value[c], shapes[k].std[c], estimate(group[k]).degrees_of_freedom});
        }
      }
    }
  }

  [[nodiscard]] ModeHistory history_of(const Places& group) const {
    ModeHistory out;
    out.log_damping.values = log_dampings(group);
    add_shape(group, out);
    return out;
  }

  void note_conditions() {
    std::size_t n_known = 0;
    for (const DatedFlight& flight : out_.flights) {
      conditions_.day.push_back(flight.day);
      conditions_.temperature_c.push_back(flight.temperature_c);
      n_known += std::isfinite(flight.temperature_c) ? 1U : 0U;
    }
    out_.knows_temperature = n_known >= core::monitoring::kLeastFlights;
    if (!out_.knows_temperature) conditions_.temperature_c.clear();
  }

  void test() {
    std::vector<History*> frequency, damping, shape;
    for (ModeHistory& one : out_.modes) {
      frequency.push_back(&one.frequency);
      damping.push_back(&one.log_damping);
      for (ModeHistory::Component& component : one.shape) shape.push_back(&component.value);
    }
    test_family(frequency, ChangeLevels::kFrequency);
    test_family(damping, ChangeLevels::kDamping);
    test_family(shape, ChangeLevels::kShape);
  }

  void test_family(const std::vector<History*>& family, double level) const {
    std::vector<FlightSeries> series;
    series.reserve(family.size());
    for (const History* one : family) series.push_back(one->values);
    const auto changes = core::monitoring::test_changes(conditions_, series, level);
    for (std::size_t i = 0; i < family.size(); ++i) family[i]->change = changes[i];
  }

  ModeHistories out_;
  core::monitoring::Conditions conditions_;
};

}  // namespace

bool ModeHistory::is_changed() const noexcept {
  return frequency.change.is_significant || log_damping.change.is_significant ||
         std::any_of(shape.begin(), shape.end(), [](const Component& c) { return c.value.change.is_significant; });
}

bool ModeHistories::is_changed() const noexcept {
  return std::any_of(modes.begin(), modes.end(), [](const ModeHistory& one) { return one.is_changed(); });
}

ModeHistories find_changes(std::vector<DatedFlight> flights) { return Histories(std::move(flights)).find(); }

}  // namespace tools
