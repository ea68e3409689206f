#include "core/identification/average_linkage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace core {
namespace {

using Clusters = std::vector<std::vector<std::size_t>>;

// By the definition: the mean over all pairs, computed again at every step.
Clusters by_definition(const std::vector<double>& distance, std::size_t n, double limit) {
  Clusters clusters;
  for (std::size_t i = 0; i < n; ++i) clusters.push_back({i});
  const auto mean = [&](const auto& a, const auto& b) {
    double sum = 0.0;
    for (const std::size_t i : a) {
      for (const std::size_t j : b) sum += distance[i * n + j];
    }
    return sum / static_cast<double>(a.size() * b.size());
  };
  for (;;) {
    std::size_t i = 0, j = 0;
    double least = limit;
    for (std::size_t a = 0; a < clusters.size(); ++a) {
      for (std::size_t b = a + 1; b < clusters.size(); ++b) {
        if (mean(clusters[a], clusters[b]) < least) least = mean(clusters[i = a], clusters[j = b]);
      }
    }
    if (i == j) return clusters;
    clusters[i].insert(clusters[i].end(), clusters[j].begin(), clusters[j].end());
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(j));
  }
}

TEST(AverageLinkage, EqualsItsDefinition) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 3.0);
  for (const std::size_t n : {1U, 2U, 9U, 40U}) {
    std::vector<double> distance(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) distance[i * n + j] = distance[j * n + i] = uniform(random);
    }
    EXPECT_EQ(average_linkage(distance, n, 1.2), by_definition(distance, n, 1.2)) << n;
  }
}

TEST(AverageLinkage, NothingGivesNothing) { EXPECT_TRUE(average_linkage({}, 0, 1.0).empty()); }

}  // namespace
}  // namespace core
