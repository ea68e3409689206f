#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "tools/validate/geometry_flight.h"

namespace tools {

// One true mode, as one way found it.
struct ModeScore {
  bool found = false;          // called structural, within 2 % of the true frequency
  bool ambiguous = false;      // its pole is there, but which of several frequencies it has was not told
  bool wrong = false;          // called structural with another's or nobody's frequency
  bool has_reference = false;  // the true motion's identification found it
  // Against the identification of the true motion; only with a reference.
  double frequency_error = 0.0, damping_error = 0.0;  // relative
  double mac = 0.0;
  // Against the true parameters, in the least possible scatter: sigma_f / f = sqrt(zeta / (2 pi f T)), sigma_zeta /
  // zeta = 1 / sqrt(2 pi zeta f T).
  double frequency_scatters = 0.0, damping_scatters = 0.0;
};

// Those inside the band of the excitation, by frequency.
[[nodiscard]] std::vector<core::simulation::TrueMode> shaken_modes(const core::simulation::Scene& scene);

struct RecordScore {
  std::vector<ModeScore> modes;  // by true frequency
  int n_false = 0;               // structural poles that belong to no mode
};
[[nodiscard]] RecordScore score(const Analysed& analysed, const std::vector<core::simulation::TrueMode>& truth,
                                double duration_s);

// The line that names the columns of print_scores.
void print_score_columns(const std::string& figure, const std::string& judged);

// Over the records of one way: what became of the first `n_judged` modes, and how many of all were found.
void print_scores(const std::string& figure, const std::string& what, const std::string& way,
                  const std::vector<RecordScore>& records, std::size_t n_judged);

// Every way of each seed; then one line for each way. A drawn case has "-drawn" behind the figure's name.
struct FigureCase {
  std::string figure;
  std::string name;
  FlightSetup setup;
  double duration_s = 300.0;
  std::size_t n_judged = 3;
  std::vector<Way> ways;
};
// The case with what the figure does not fix drawn from the seed.
[[nodiscard]] FigureCase drawn_case(FigureCase which, const DrawnFlight& limits);

// [way][record]
using CaseScores = std::vector<std::vector<RecordScore>>;
[[nodiscard]] CaseScores score_case(const FigureCase& which, const GeometryOptions& options);
void print_case(const FigureCase& which, const GeometryOptions& options);

}  // namespace tools
