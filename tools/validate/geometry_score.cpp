#include "tools/validate/geometry_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/identification/mac.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::TrueMode;
using As = Found::As;

ModeScore score_mode(const Found& found, const Found& reference, const TrueMode& truth, double duration_s) {
  ModeScore out;
  out.found = found.as == As::kRight;
  out.ambiguous = found.as == As::kAmbiguous;
  out.wrong = found.as == As::kWrongFold;
  out.has_reference = reference.as == As::kRight;
  if (!out.found) return out;
  const double turns = 2.0 * std::numbers::pi * truth.frequency_hz * duration_s;
  out.frequency_scatters =
      (found.mode.frequency_hz / truth.frequency_hz - 1.0) / std::sqrt(truth.damping_ratio / turns);
  out.damping_scatters =
      (found.mode.damping_ratio / truth.damping_ratio - 1.0) * std::sqrt(truth.damping_ratio * turns);
  if (!out.has_reference) return out;
  out.frequency_error = found.mode.frequency_hz / reference.mode.frequency_hz - 1.0;
  out.damping_error = found.mode.damping_ratio / reference.mode.damping_ratio - 1.0;
  out.mac = core::mac(found.mode.shape, reference.mode.shape);
  return out;
}

// Of one record: the worst of the evaluated modes that were found.
struct WorstOfRecord {
  double frequency = 0.0, damping = 0.0, mac = 1.0;
  bool any = false, all = true;
};

WorstOfRecord worst_of(const RecordScore& record, std::size_t n_judged) {
  WorstOfRecord worst;
  for (std::size_t r = 0; r < std::min(n_judged, record.modes.size()); ++r) {
    const ModeScore& mode = record.modes[r];
    worst.all = worst.all && mode.found;
    if (!mode.found || !mode.has_reference) continue;
    worst.any = true;
    worst.frequency = std::max(worst.frequency, std::abs(mode.frequency_error));
    worst.damping = std::max(worst.damping, std::abs(mode.damping_error));
    worst.mac = std::min(worst.mac, mode.mac);
  }
  return worst;
}

// Over the records of one way.
struct Tally {
  int complete = 0;
  double n_false = 0.0, n_ambiguous = 0.0, n_wrong = 0.0;
  std::vector<double> frequency, damping, mac_deficit;  // of each record with an evaluated mode
  std::vector<double> n_found;                          // of each record
  std::size_t most_missing = 0;
  std::vector<double> frequency_scatters, damping_scatters;
};

Tally tally_of(const std::vector<RecordScore>& records, std::size_t n_judged) {
  Tally tally;
  for (const RecordScore& record : records) {
    double n_found = 0.0;
    for (std::size_t r = 0; r < record.modes.size(); ++r) {
      const ModeScore& mode = record.modes[r];
      tally.n_ambiguous += mode.ambiguous ? 1.0 : 0.0;
      tally.n_wrong += mode.wrong ? 1.0 : 0.0;
      n_found += mode.found ? 1.0 : 0.0;
      if (!mode.found || r >= n_judged) continue;
      tally.frequency_scatters.push_back(mode.frequency_scatters);
      tally.damping_scatters.push_back(mode.damping_scatters);
    }
    const WorstOfRecord worst = worst_of(record, n_judged);
    tally.n_found.push_back(n_found);
    tally.most_missing = std::max(tally.most_missing, record.modes.size() - static_cast<std::size_t>(n_found));
    tally.complete += worst.all ? 1 : 0;
    tally.n_false += record.n_false;
    if (!worst.any) continue;
    tally.frequency.push_back(worst.frequency);
    tally.damping.push_back(worst.damping);
    tally.mac_deficit.push_back(worst.mac - 1.0);
  }
  return tally;
}

// "nan<tab>nan" if empty, so that no bar is met by accident.
std::string median_and_worst(const std::vector<double>& values, double factor, const char* format) {
  const double nan = std::nan("");
  const Statistics s = statistics(values);
  const double median = values.empty() ? nan : factor * s.median, worst = values.empty() ? nan : factor * s.worst;
  return fmt::format(fmt::runtime(fmt::format("{}\t{}", format, format)), median, worst);
}

}  // namespace

RecordScore score(const Analysed& analysed, const std::vector<TrueMode>& truth, double duration_s) {
  const Match measured = match_modes(analysed.measured, truth, analysed.channels);
  const Match reference = match_modes(analysed.truth, truth, analysed.channels);
  RecordScore out;
  out.n_false = measured.n_false;
  for (std::size_t r = 0; r < truth.size(); ++r) {
    out.modes.push_back(score_mode(measured.modes[r], reference.modes[r], truth[r], duration_s));
  }
  return out;
}

void print_score_columns(const std::string& figure, const std::string& judged) {
  fmt::print(
      "# {}: case, way, records; {}: records with all of them; worst of them in a record against the true motion's\n"
      "#   own identification, over the records: frequency % median, worst; damping % median, worst; least MAC "
      "median,\n"
      "#   worst; of all true modes found median, fewest, of; judged modes against the true parameters in the least\n"
      "#   possible scatter: frequency rms, worst, damping rms, worst; per record: structural poles that are no mode;\n"
      "#   modes ambiguous, modes given a wrong frequency; most modes that a record lacks\n",
      figure, judged);
}

void print_scores(const std::string& figure, const std::string& what, const std::string& way,
                  const std::vector<RecordScore>& records, std::size_t n_judged) {
  const Tally tally = tally_of(records, n_judged);
  const double n = static_cast<double>(std::max<std::size_t>(1, records.size()));
  const Statistics k = statistics(tally.n_found), f = statistics(tally.frequency_scatters),
                   z = statistics(tally.damping_scatters), mac = statistics(tally.mac_deficit);
  const double fewest = tally.n_found.empty() ? 0.0 : *std::min_element(tally.n_found.begin(), tally.n_found.end());
  const double known = tally.mac_deficit.empty() ? std::nan("") : 1.0;
  fmt::print("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.5f}\t{:.5f}\t{:g}\t{:g}\t{}", figure, what, way, records.size(),
             tally.complete, median_and_worst(tally.frequency, 1e2, "{:.4f}"),
             median_and_worst(tally.damping, 1e2, "{:.2f}"), known * (1.0 + mac.median), known * (1.0 + mac.worst),
             k.median, fewest, records.empty() ? 0 : records.front().modes.size());
  fmt::print("\t{:.2f}\t{:+.2f}\t{:.2f}\t{:+.2f}\t{:.2f}\t{:.2f}\t{:.2f}\t{}\n", f.rms, f.worst, z.rms, z.worst,
             tally.n_false / n, tally.n_ambiguous / n, tally.n_wrong / n, tally.most_missing);
  std::fflush(stdout);
}

std::vector<TrueMode> shaken_modes(const core::simulation::Scene& scene) {
  std::vector<TrueMode> modes = modes_of(scene.structure);
  std::erase_if(modes, [&](const TrueMode& mode) { return mode.frequency_hz > scene.excitation.band_high_hz; });
  return modes;
}

FigureCase drawn_case(FigureCase which, const DrawnFlight& limits) {
  which.figure += "-drawn";
  which.setup.drawn = limits;
  return which;
}

CaseScores score_case(const FigureCase& which, const GeometryOptions& options) {
  const auto records = for_each_seed(options, [&](std::uint64_t seed) {
    const SimulateJob job = flight_job(which.setup, seed, which.duration_s, options);
    const std::vector<TrueMode> truth = shaken_modes(job.scene());
    const AnalysedFlight result = analyse_flight(job, which.setup, which.ways);
    std::vector<RecordScore> scores;
    for (const Analysed& way : result.ways) scores.push_back(score(way, truth, result.duration_s));
    return scores;
  });
  CaseScores by_way(which.ways.size());
  for (const auto& record : records) {
    for (std::size_t w = 0; w < by_way.size(); ++w) by_way[w].push_back(record[w]);
  }
  return by_way;
}

void print_case(const FigureCase& which, const GeometryOptions& options) {
  const CaseScores scores = score_case(which, options);
  for (std::size_t w = 0; w < scores.size(); ++w) {
    print_scores(which.figure, which.name, which.ways[w].name, scores[w], which.n_judged);
  }
}

}  // namespace tools
