#include "tools/hovermodal/batch/combine.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "drivers/storage/checkpoint_file.h"
#include "firmware_app/chain/state/setup_sums.h"
#include "tools/hovermodal/batch/flight_order.h"
#include "tools/hovermodal/changes/matched_flights.h"

namespace tools {

namespace {

namespace fs = std::filesystem;

app::SetupSums read_sums(const std::string& folder) {
  const std::string path = (fs::path(folder) / kSumsFile).string();
  const drivers::CheckpointRead read = drivers::read_checkpoint(path);
  if (!read.exists) throw std::runtime_error(path + ": is not there");
  if (!read.refused.empty()) throw std::runtime_error(path + ": " + read.refused);
  return app::setup_sums_of(read.bytes);
}

class Combination {
 public:
  Combination(std::vector<FlightResult> flights, const std::vector<std::string>& folders) : folders_(folders) {
    result_.flights = std::move(flights);
  }

  [[nodiscard]] BatchResult combine() {
    for (std::size_t f = 0; f < result_.flights.size(); ++f) {
      FlightResult& flight = result_.flights[f];
      if (!flight.failure.empty()) continue;
      try {
        sort_in(f);
      } catch (const std::exception& e) {
        flight.failure = e.what();
      }
    }
    leave_out_contradictions();
    for (std::size_t v = 0; v < result_.views.size(); ++v) identify(v);
    list_modes();
    return std::move(result_);
  }

 private:
  struct Seen {
    std::size_t i_flight;
    app::SumsFingerprint print;
  };

  // Adds the flight to the first view that it fits.
  void sort_in(std::size_t f) {
    FlightResult& flight = result_.flights[f];
    flight.report = app::read_modal_json((fs::path(folders_[f]) / kModesFile).string());
    const app::SetupSums sums = read_sums(folders_[f]);
    app::SumsFingerprint print = app::fingerprint(sums.record.sums);
    for (const Seen& seen : seen_) {
      if (app::same_samples(seen.print, print))
        throw std::runtime_error(
            fmt::format("has the same samples as {}: counted once", result_.flights[seen.i_flight].name));
    }
    app::SetupSums head = app::without_sums(sums);
    std::size_t v = 0;
    while (v < heads_.size() && !app::why_other_view(heads_[v], head).empty()) ++v;
    if (v == heads_.size()) {
      result_.views.emplace_back().why = v > 0 ? app::why_other_view(heads_.front(), head) : "";
      heads_.push_back(std::move(head));
      n_segments_.push_back(0);
    }
    result_.views[v].flights.push_back(f);
    n_segments_[v] += sums.record.sums.n_segments;
    flight.i_view = v;
    seen_.push_back({f, std::move(print)});
  }

  // A view of which all flights contradict keeps them: there is nothing else to show of it.
  void leave_out_contradictions() {
    std::vector<const app::ModalReport*> reports;
    std::vector<std::size_t> flight_of;
    core::monitoring::Conditions conditions;
    for (std::size_t f = 0; f < result_.flights.size(); ++f) {
      if (!result_.flights[f].failure.empty()) continue;
      conditions.day.push_back(static_cast<double>(f));
      reports.push_back(&result_.flights[f].report);
      flight_of.push_back(f);
    }
    for (const auto& one : match_flights(reports, conditions).contradicting) {
      FlightResult& flight = result_.flights[flight_of[one.flight]];
      std::vector<std::size_t>& of_view = result_.views[flight.i_view].flights;
      flight.contradiction = words_of(one);
      if (of_view.size() > 1) std::erase(of_view, flight_of[one.flight]);
    }
  }

  void identify(std::size_t v) {
    ViewResult& view = result_.views[v];
    view.report = result_.flights[view.flights.front()].report;
    if (view.flights.size() == 1) return;
    app::ViewTotal total(n_segments_[v]);
    view.report.losses = {};
    for (const std::size_t f : view.flights) {
      total.add(read_sums(folders_[f]));
      const core::Health& one = result_.flights[f].report.losses;
      view.report.losses.frames_in += one.frames_in;
      view.report.losses.frames_processed += one.frames_processed;
      view.report.losses.frames_dropped += one.frames_dropped;
      view.report.losses.frames_missing += one.frames_missing;
      view.report.losses.samples_masked += one.samples_masked;
    }
    view.report.estimate = total.identify();
  }

  // Views first, then the flights of single-flight views only: the data of the others are in their view's estimate.
  void list_modes() {
    std::vector<core::EstimateInput> inputs;
    std::vector<std::size_t> flight_of_input;
    for (const ViewResult& view : result_.views) {
      inputs.push_back({view.report.channel_names, &view.report.estimate, true});
    }
    for (std::size_t f = 0; f < result_.flights.size(); ++f) {
      const FlightResult& flight = result_.flights[f];
      if (!flight.failure.empty() || !flight.contradiction.empty()) continue;
      if (result_.views[flight.i_view].flights.size() == 1) continue;
      inputs.push_back({flight.report.channel_names, &flight.report.estimate, false});
      flight_of_input.push_back(f);
    }
    for (const core::ModeGroup& group : core::combine_estimates(inputs)) {
      BatchMode mode{group.frequency_hz, group.damping_ratio, {}, {}, {}, {}};
      std::vector<core::ModePlace> of_flights;
      for (const core::ModePlace& place : group.members) {
        const bool is_view = place.i_estimate < result_.views.size();
        if (is_view) mode.views.push_back({place.i_estimate, place.i_mode});
        if (is_view && result_.views[place.i_estimate].flights.size() > 1) continue;
        mode.flights.push_back({is_view ? result_.views[place.i_estimate].flights.front()
                                        : flight_of_input[place.i_estimate - result_.views.size()],
                                place.i_mode});
        of_flights.push_back(place);
      }
      mode.flights_frequency_hz = core::mean_frequency(inputs, of_flights);
      mode.flights_damping_ratio = core::mean_damping(inputs, of_flights);
      (mode.frequency_hz.n > 0 ? result_.modes : result_.unsettled).push_back(std::move(mode));
    }
  }

  const std::vector<std::string>& folders_;
  BatchResult result_;
  std::vector<app::SetupSums> heads_;      // of each view: the sums of its first flight, without the spectra
  std::vector<std::uint64_t> n_segments_;  // of each view
  std::vector<Seen> seen_;
};

}  // namespace

BatchResult combine_flights(const std::vector<FlightOrder>& orders, const std::vector<std::string>& failures) {
  std::vector<FlightResult> flights;
  std::vector<std::string> folders;
  for (std::size_t f = 0; f < orders.size(); ++f) {
    flights.push_back({orders[f].flight.name, orders[f].flight.kind, failures[f], "", 0, {}});
    folders.push_back(orders[f].into);
  }
  return Combination(std::move(flights), folders).combine();
}

}  // namespace tools
