#pragma once

#include <complex>
#include <string>
#include <vector>

#include "core/simulation/structure/structure_model.h"
#include "core/types/modal_estimate.h"
#include "tools/validate/identification_record.h"

namespace tools {

// A true mode and the corresponding result.
struct Found {
  enum class As : unsigned char { kAbsent, kRight, kWrongFold, kAmbiguous };
  As as = As::kAbsent;
  core::Mode mode;   // empty when absent
  double mac = 0.0;  // with the true shape
};

// Correct: structural, within 2 % of the true frequency. Wrong alias: structural within 3 % of where the mode appears,
// with the frequency of another mode or of none. Every pole is used once.
struct Match {
  std::vector<Found> modes;  // by true frequency
  int n_false = 0;           // structural poles that belong to no mode
};
[[nodiscard]] Match match_modes(const core::ModalEstimate& estimate,
                                const std::vector<core::simulation::TrueMode>& truth,
                                const std::vector<core::ChannelInfo>& channels);

// Its shape in these channels, which are named after their bodies (floor3, deck12.v); the base does not move.
[[nodiscard]] std::vector<std::complex<double>> true_shape(const core::simulation::TrueMode& mode,
                                                           const std::vector<core::ChannelInfo>& channels);

// MAC of a pole's shape with a true mode's, in these channels.
[[nodiscard]] double shape_mac(const core::simulation::TrueMode& truth, const core::Mode& mode,
                               const std::vector<core::ChannelInfo>& channels);

// Where a frequency appears in the sampled spectrum, 0 .. rate / 2.
[[nodiscard]] double apparent_hz(double frequency_hz, double rate_hz) noexcept;

struct Statistics {
  std::size_t n = 0;
  double mean = 0.0, standard_deviation = 0.0, standard_error = 0.0;  // of the mean
  double median = 0.0, rms = 0.0, worst = 0.0;                        // worst: largest magnitude
};
// Of an empty list: NaN, so that no bar is met by accident.
[[nodiscard]] Statistics statistics(std::vector<double> values);

}  // namespace tools
