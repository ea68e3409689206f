#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace core::closure {

// Free decays cut from a record: per release samples x channels, in the record's unit.
struct FreeDecays {
  double rate_hz = 0.0;
  std::vector<std::string> channels;
  std::string unit;
  std::vector<Eigen::MatrixXd> release;
  std::vector<std::size_t> start;  // of each release, index of a sample of the record
  double noise_rms = 0.0;          // of a sample, from the quietest part of the record; 0 = unknown
};

struct ReleaseSearch {
  double length_s = 1.3;  // of a decay, largest
  double sudden = 0.2;    // a release begins with a step of this size, relative to the record's largest ...
  double quiet = 0.1;     // ... after five steps smaller than this
};

// A structure that is pulled and released: a decay begins where a sudden step moves the largest channel across its
// equilibrium, and ends after length_s, at the next release, or at a missing sample. `value`: per channel, NaN =
// missing. Throws std::invalid_argument: fewer than three releases of at least 12 samples, channels of different
// length, no rate.
[[nodiscard]] FreeDecays find_free_decays(const std::vector<std::vector<double>>& value, double rate_hz,
                                          const std::vector<std::string>& channels, const std::string& unit,
                                          const ReleaseSearch& search = {});

}  // namespace core::closure
