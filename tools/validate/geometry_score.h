#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "tools/validate/geometry_flight.h"

namespace tools {

// One true mode, and the result of one way for it.
struct ModeScore {
  bool found = false;          // structural, within 2 % of the true frequency
  bool ambiguous = false;      // its pole was found, but its alias order not determined
  bool wrong = false;          // structural, with the frequency of another mode or of none
  bool has_reference = false;  // found in the identification of the true motion
  // Relative to the identification of the true motion; only with a reference.
  double frequency_error = 0.0, damping_error = 0.0;  // relative
  double mac = 0.0;
  // Relative to the true parameters, in units of the least scatter: sigma_f / f = sqrt(zeta / (2 pi f T)), sigma_zeta /
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

// Over the records of one way: results for the first `n_judged` modes, and how many of all were found.
void print_scores(const std::string& figure, const std::string& what, const std::string& way,
                  const std::vector<RecordScore>& records, std::size_t n_judged);

// Every way for each seed; then one line per way. A drawn case has "-drawn" after the figure's name.
struct FigureCase {
  std::string figure;
  std::string name;
  FlightSetup setup;
  double duration_s = 300.0;
  std::size_t n_judged = 3;
  std::vector<Way> ways;
};
// The same case with everything that the figure does not fix drawn from the seed.
[[nodiscard]] FigureCase drawn_case(FigureCase which, const DrawnFlight& limits);

// [way][record]
using CaseScores = std::vector<std::vector<RecordScore>>;
[[nodiscard]] CaseScores score_case(const FigureCase& which, const GeometryOptions& options);
void print_case(const FigureCase& which, const GeometryOptions& options);

}  // namespace tools
