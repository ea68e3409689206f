#pragma once

#include <cstddef>
#include <vector>

namespace core {

// Agglomerative clustering by average linkage (Lance & Williams 1967), cut at `limit`: the two nearest clusters are
// joined (of equal pairs the first) until no pair is nearer than the limit. `distance`: n x n, symmetric. Clusters are
// ordered by their first members. Nearest neighbours are cached, so that n^2 steps suffice in practice.
[[nodiscard]] std::vector<std::vector<std::size_t>> average_linkage(std::vector<double> distance, std::size_t n,
                                                                    double limit);

}  // namespace core
