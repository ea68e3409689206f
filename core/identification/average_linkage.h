#pragma once

#include <cstddef>
#include <vector>

namespace core {

// Agglomerative clustering by average linkage (Lance & Williams 1967), cut at `limit`: the nearest two clusters are
// joined, the first pair of equals, until none are nearer than that. `distance`: n x n, symmetric. Clusters are ordered
// by their first members. Nearest neighbours are cached: n^2 steps in practice.
[[nodiscard]] std::vector<std::vector<std::size_t>> average_linkage(std::vector<double> distance, std::size_t n,
                                                                    double limit);

}  // namespace core
