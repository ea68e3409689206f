#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/types/displacement.h"

namespace app {

// What is subtracted from every sample after a change of geometry, so that displacements do not jump there: the mean
// difference of the two measurements over the frames before it. Sized once.
class SampleOffset {
 public:
  SampleOffset() = default;  // subtracts nothing
  explicit SampleOffset(const core::DisplacementSample& prototype)
      : values_(prototype.value_mm.size()), witnesses_(prototype.witness_mm.size()) {}

  void clear() noexcept {
    for (Mean& mean : values_) mean = {};
    for (Mean& mean : witnesses_) mean = {};
  }
  // The same frame as measured before the change and after it.
  void add(const core::DisplacementSample& before, const core::DisplacementSample& after) noexcept {
    add(before.value_mm, before.seen, after.value_mm, after.seen, values_);
    add(before.witness_mm, before.witness_seen, after.witness_mm, after.witness_seen, witnesses_);
  }
  // False: a channel was not seen by both in any frame.
  [[nodiscard]] bool is_known() const noexcept { return is_known(values_) && is_known(witnesses_); }
  void subtract_from(core::DisplacementSample& sample) const noexcept {
    subtract(values_, sample.value_mm);
    subtract(witnesses_, sample.witness_mm);
  }

 private:
  struct Mean {
    double sum = 0.0;
    std::uint32_t n = 0;
  };

  static void add(const std::vector<double>& before, const std::vector<std::uint8_t>& before_seen,
                  const std::vector<double>& after, const std::vector<std::uint8_t>& after_seen,
                  std::vector<Mean>& means) noexcept {
    for (std::size_t i = 0; i < means.size(); ++i) {
      if (before_seen[i] == 0 || after_seen[i] == 0) continue;
      means[i].sum += after[i] - before[i];
      ++means[i].n;
    }
  }
  static bool is_known(const std::vector<Mean>& means) noexcept {
    for (const Mean& mean : means) {
      if (mean.n == 0) return false;
    }
    return true;
  }
  static void subtract(const std::vector<Mean>& means, std::vector<double>& values) noexcept {
    for (std::size_t i = 0; i < means.size() && i < values.size(); ++i) {
      if (means[i].n > 0) values[i] -= means[i].sum / means[i].n;
    }
  }

  std::vector<Mean> values_, witnesses_;
};

}  // namespace app
