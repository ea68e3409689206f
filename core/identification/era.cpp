#include "core/identification/era.h"

#include <cmath>

#include "core/identification/given_inputs.h"
#include "core/identification/modal_coherence.h"
#include "core/identification/realisation_by_gram.h"
#include "core/identification/realisation_by_svd.h"
#include "core/linear/real_eigen.h"

namespace core {

EraStatus realise(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  if (correlations.max_lag() < furthest_lag(config)) return EraStatus::kTooFewLags;
  const GramStatus status = realise_by_gram(correlations, config, out);
  if (status == GramStatus::kOk) return EraStatus::kOk;
  if (status == GramStatus::kRankDeficient) return EraStatus::kRankDeficient;
  return realise_by_svd(correlations, config, out);
}

std::vector<DiscretePole> poles_of_order(const Realisation& realisation, int order) {
  const Eigen::Index n = std::min<Eigen::Index>(order, realisation.a.rows());
  UpperEigen eigen;
  std::vector<DiscretePole> poles;
  if (n < 2) return poles;
  const Eigen::Index ny = realisation.c.rows();
  Eigen::MatrixXd seen(ny + realisation.c_last.rows(), n);
  seen << realisation.c.leftCols(n), realisation.c_last.leftCols(n);
  if (!upper_half_plane_eigen(realisation.a.topLeftCorner(n, n), seen, eigen)) return poles;
  for (std::size_t k = 0; k < eigen.values.size(); ++k) {
    if (!std::isfinite(std::abs(eigen.values[k]))) continue;
    const Eigen::VectorXcd both = eigen.seen.col(static_cast<Eigen::Index>(k));
    const std::vector<std::complex<double>> shape(both.begin(), both.begin() + ny), last(both.begin() + ny, both.end());
    poles.push_back({eigen.values[k], shape, output_emac(shape, last, std::pow(eigen.values[k], realisation.n_steps))});
  }
  return poles;
}

int canonical_order(const Realisation& realisation, double threshold) {
  return canonical_order(realisation.singular_values.head(realisation.a.rows()), threshold);
}

int canonical_order(const Eigen::Ref<const Eigen::VectorXd>& singular_values, double threshold) {
  const auto count = static_cast<int>((singular_values.array() > threshold).count());
  return count + count % 2;
}

}  // namespace core
