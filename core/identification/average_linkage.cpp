#include "core/identification/average_linkage.h"

#include <limits>
#include <utility>

namespace core {

namespace {

constexpr double kFarApart = std::numeric_limits<double>::infinity();

class AverageLinkage {
 public:
  AverageLinkage(std::vector<double> distance, std::size_t n)
      : n_(n), distance_(std::move(distance)), members_(n), nearest_(n, 0), nearest_distance_(n, kFarApart) {
    for (std::size_t i = 0; i < n; ++i) members_[i] = {i};
    for (std::size_t i = 0; i < n; ++i) find_nearest(i);
  }

  std::vector<std::vector<std::size_t>> cut(double limit) {
    for (;;) {
      std::size_t best = n_;
      double least = limit;
      for (std::size_t i = 0; i < n_; ++i) {
        if (nearest_distance_[i] < least) {
          least = nearest_distance_[i];
          best = i;
        }
      }
      if (best == n_) break;
      merge(best, nearest_[best]);
    }
    std::erase_if(members_, [](const auto& members) { return members.empty(); });
    return std::move(members_);
  }

 private:
  [[nodiscard]] double& at(std::size_t i, std::size_t j) { return distance_[i * n_ + j]; }

  // Finds the nearest of the clusters after i.
  void find_nearest(std::size_t i) {
    nearest_distance_[i] = kFarApart;
    const double* row = distance_.data() + i * n_;
    for (std::size_t j = i + 1; j < n_; ++j) {
      if (row[j] < nearest_distance_[i] && !members_[j].empty()) {
        nearest_distance_[i] = row[j];
        nearest_[i] = j;
      }
    }
  }

  void merge(std::size_t i, std::size_t j) {
    const auto ni = static_cast<double>(members_[i].size());
    const auto nj = static_cast<double>(members_[j].size());
    members_[i].insert(members_[i].end(), members_[j].begin(), members_[j].end());
    members_[j].clear();
    nearest_distance_[j] = kFarApart;
    for (std::size_t k = 0; k < n_; ++k) {
      if (k == i || members_[k].empty()) continue;
      const double joined = (ni * at(i, k) + nj * at(j, k)) / (ni + nj);
      at(i, k) = joined;
      at(k, i) = joined;
    }
    find_nearest(i);
    for (std::size_t k = 0; k < j; ++k) {
      if (k == i || members_[k].empty() || nearest_distance_[k] == kFarApart) continue;
      if (nearest_[k] == i || nearest_[k] == j) {
        find_nearest(k);
      } else if (k < i && (at(k, i) < nearest_distance_[k] || (at(k, i) == nearest_distance_[k] && i < nearest_[k]))) {
        nearest_distance_[k] = at(k, i);
        nearest_[k] = i;
      }
    }
  }

  std::size_t n_;
  std::vector<double> distance_;
  std::vector<std::vector<std::size_t>> members_;
  std::vector<std::size_t> nearest_;
  std::vector<double> nearest_distance_;
};

}  // namespace

std::vector<std::vector<std::size_t>> average_linkage(std::vector<double> distance, std::size_t n, double limit) {
  return AverageLinkage(std::move(distance), n).cut(limit);
}

}  // namespace core
