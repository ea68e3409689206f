#include "core/identification/block_deviations.h"

#include <algorithm>
#include <span>

#include "core/identification/pair_transform.h"

namespace core {

namespace {

using Eigen::Index;

class Deviations {
 public:
  Deviations(const CpsdSums& sums, const DeviationLags& lags, std::size_t n_groups)
      : sums_(sums), lags_(lags), transform_(sums), shared_mask_(one_mask(sums)), groups_(n_groups), mask_(n_groups) {
    for (std::size_t g = 0; g < n_groups; ++g) {
      const std::size_t first = g * sums.n_blocks / n_groups, last = (g + 1) * sums.n_blocks / n_groups;
      groups_[g] = std::span(sums.blocks).subspan(first, last - first);
    }
  }

  [[nodiscard]] double degrees_of_freedom() const {
    double sum = 0.0, squares = 0.0;
    for (const std::span<const CpsdBlock> group : groups_) {
      double variance = 0.0;
      for (const CpsdBlock& block : group) variance += block.weight.squares;
      sum += variance;
      squares += variance * variance;
    }
    return squares > 0.0 ? std::max(0.0, sum * sum / squares - 1.0) : 0.0;
  }

  // Transforms R(i, j, lag), i <= j, lags of either sign, of all parts but the last, which is minus their sum.
  void transform(int i, int j) {
    const int pair = CpsdSums::pair_index(i, j, sums_.n_channels);
    same_mask_ = shared_mask_ && !mask_.front().empty();
    transform_.inverse(sums_.data_sum, pair, r_);
    if (!same_mask_) transform_.inverse(sums_.mask_sum, pair, all_mask_);
    for (std::size_t k = 0; k < r_.size(); ++k) r_[k] /= all_mask_[k];
    data_.resize(groups_.size() - 1);
    for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
      transform_.inverse(groups_[g], &CpsdBlock::data_sum, pair, data_[g]);
      if (!same_mask_) transform_.inverse(groups_[g], &CpsdBlock::mask_sum, pair, mask_[g]);
    }
  }

  // Writes rows of `channel`, columns of the `reference`-th of n_references. mirrored: the transformed pair is (j, i).
  void write(Index channel, Index reference, Index n_references, bool mirrored, Eigen::MatrixXd& out) {
    const int reach = lags_.n_differences;
    const Index n_channels = sums_.n_channels, last = channel + n_channels * static_cast<Index>(data_.size());
    for (int k = 0; k < lags_.n; ++k) out(last, k * n_references + reference) = 0.0;
    for (std::size_t g = 0; g < data_.size(); ++g) {
      moved_.clear();
      for (int lag = lags_.first - reach; lag < lags_.first + lags_.n + reach; ++lag) {
        const std::size_t at = circular(mirrored ? -lag : lag, sums_.n_fft);
        moved_.push_back((data_[g][at] - r_[at] * mask_[g][at]) / all_mask_[at]);
      }
      difference_lags(moved_, lags_.n_differences);
      const Index row = channel + n_channels * static_cast<Index>(g);
      for (int k = 0; k < lags_.n; ++k) {
        const Index column = k * n_references + reference;
        out(row, column) = moved_[static_cast<std::size_t>(k)];
        out(last, column) -= out(row, column);
      }
    }
  }

 private:
  const CpsdSums& sums_;
  const DeviationLags& lags_;
  PairTransform transform_;
  bool shared_mask_, same_mask_ = false;
  std::vector<std::span<const CpsdBlock>> groups_;
  std::vector<std::vector<double>> data_, mask_;  // circular lags per part
  std::vector<double> r_, all_mask_, moved_;
};

}  // namespace

BlockDeviations block_deviations(const CpsdSums& sums, const std::vector<int>& references, const DeviationLags& lags,
                                 std::size_t n_groups) {
  if (n_groups < 2 || sums.n_blocks < n_groups) return {};
  const auto n_references = static_cast<Index>(references.size());
  Deviations deviations(sums, lags, n_groups);
  BlockDeviations out{static_cast<int>(n_groups), deviations.degrees_of_freedom(), {}};
  out.value.resize(static_cast<Index>(n_groups) * sums.n_channels, lags.n * n_references);
  const auto place = [&](int channel) { return std::find(references.begin(), references.end(), channel); };
  for (int i = 0; i < sums.n_channels; ++i) {
    for (int j = i; j < sums.n_channels; ++j) {
      const auto of_i = place(i), of_j = place(j);
      if (of_i == references.end() && of_j == references.end()) continue;
      deviations.transform(i, j);
      if (of_j != references.end()) deviations.write(i, of_j - references.begin(), n_references, false, out.value);
      if (i != j && of_i != references.end()) {
        deviations.write(j, of_i - references.begin(), n_references, true, out.value);
      }
    }
  }
  return out;
}

}  // namespace core
