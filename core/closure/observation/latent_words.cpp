#include "core/closure/observation/latent_words.h"

#include <algorithm>
#include <cmath>

#include "core/closure/observation/smooth_share.h"
#include "core/closure/observation/strongest_hz.h"

namespace core::closure {
namespace {

constexpr double kToldSignal = 0.3;  // smallest share of the amplitude's variance that is reported

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

std::string place_words(const Eigen::VectorXd& field, const ObservationRecord& record) {
  std::vector<double> share(record.regions.size(), 0.0);
  double along_v = 0.0;
  const double whole = std::max(field.squaredNorm(), 1e-300);
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    share[record.region_of_point[static_cast<std::size_t>(j)]] += field.segment<2>(2 * j).squaredNorm() / whole;
    along_v += field(2 * j + 1) * field(2 * j + 1) / whole;
  }
  const auto most = static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin());
  return "most (" + percent(share[most]) + ") in region " + record.regions[most].name + ", " + percent(along_v) +
         " of it along v";
}

}  // namespace

std::string latent_words(const Eigen::VectorXd& field, const Eigen::RowVectorXd& amplitude,
                         const ObservationRecord& record, const PointGeometry& geometry,
                         const std::vector<KnownSignal>& known) {
  std::string out = place_words(field, record);
  const double plane = smooth_share(field, geometry, false), curved = smooth_share(field, geometry, true);
  out += "; a linear field over the image explains " + percent(plane) + " of it, a quadratic one " + percent(curved);
  std::string hz = std::to_string(strongest_hz(amplitude, record.rate_hz));
  out += "; strongest at " + hz.substr(0, hz.find('.') + 3) + " Hz";
  const Eigen::RowVectorXd a = amplitude.array() - amplitude.mean();
  double best = kToldSignal;
  std::string words;
  for (const KnownSignal& signal : known) {
    const Eigen::RowVectorXd s = signal.series.array() - signal.series.mean();
    const double norm = s.squaredNorm() * a.squaredNorm();
    const double share = norm > 0.0 ? s.dot(a) * s.dot(a) / norm : 0.0;
    if (share > best)
      best = share, words = "; correlates with " + signal.name + " (" + percent(share) + " of its variance)";
  }
  return out + words;
}

}  // namespace core::closure
