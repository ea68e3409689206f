#include "core/monitoring/change_test.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/closure/noise_stream.h"
#include "core/linear/median.h"

namespace core::monitoring {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kSurrogates = 1999;
constexpr std::size_t kMostSteps = 200;  // candidates of one series; beyond, every second flight, every third ...
constexpr double kLeastOwnShare = 0.05;  // of a candidate's squares that constant and temperature do not explain
constexpr double kClearKind = 3.84;      // chi-square, one degree of freedom, 95 %
constexpr double kSharedFreedom = 8.0;   // degrees of freedom by which the median of all flights' variances counts
constexpr std::uint64_t kSeed = 20170704;

// One change that a series may have.
struct Candidate {
  ChangeKind kind;
  std::size_t first_flight;  // of a step
  VectorXd direction;        // of unit length, without constant and temperature
  double length;             // of the weighted regressor without constant and temperature
  VectorXd regressor;        // weighted
};

struct Best {
  double statistic = -1.0;  // negative: no candidate
  std::size_t candidate = 0;
  double variance = 1.0;  // of the residual, in units of the stated one
};

// The regression of one series: all that does not depend on the values.
class Design {
 public:
  Design(const Conditions& conditions, const FlightSeries& series) {
    for (const FlightValue& value : series) {
      if (!conditions.temperature_c.empty() && !std::isfinite(conditions.temperature_c[value.flight])) continue;
      values_.push_back(value);
    }
    const auto n = static_cast<Index>(values_.size());
    if (values_.size() < kLeastFlights) return;
    share_variances();
    weights_.resize(n);
    for (Index k = 0; k < n; ++k) weights_(k) = 1.0 / at(k).std;
    basis_.push_back(weights_.normalized());
    add_temperature(conditions);
    add_candidates(conditions);
  }

  [[nodiscard]] bool is_tested() const noexcept { return !candidates_.empty(); }
  [[nodiscard]] const FlightSeries& values() const noexcept { return values_; }
  [[nodiscard]] const Candidate& candidate(std::size_t i) const { return candidates_[i]; }

  // y: weighted values; `kind`: of candidates of this kind only. Of two candidates that explain as much the earlier
  // one.
  [[nodiscard]] Best best(const VectorXd& y, std::optional<ChangeKind> kind = std::nullopt) const {
    Best out;
    const VectorXd rest = without_basis(y);
    const double squares = rest.squaredNorm();
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (kind && candidates_[i].kind != *kind) continue;
      const double gain = std::pow(candidates_[i].direction.dot(rest), 2);
      const double variance = std::max(0.0, squares - gain) / freedom();
      const double statistic = gain / std::max(1.0, variance);
      if (statistic > out.statistic) out = {statistic, i, variance};
    }
    return out;
  }

  [[nodiscard]] VectorXd weighted() const {
    VectorXd y(weights_.size());
    for (Index k = 0; k < y.size(); ++k) y(k) = weights_(k) * at(k).value;
    return y;
  }
  // What the best candidate leaves, in its own standard deviations and corrected for the parameters fitted.
  [[nodiscard]] VectorXd left_by(const Best& best) const {
    const VectorXd rest = without_basis(weighted());
    const Candidate& chosen = candidates_[best.candidate];
    const auto n = static_cast<double>(values_.size());
    return (rest - chosen.direction.dot(rest) * chosen.direction) * std::sqrt(n / freedom());
  }
  // The residuals of the flights in any order, repeated, with any sign: errors that are no Student's t (a shape beside
  // a close mode) have their own tails.
  [[nodiscard]] static VectorXd resampled(closure::NoiseStream& noise, const VectorXd& left) {
    VectorXd y(left.size());
    for (Index k = 0; k < y.size(); ++k) {
      const auto from = static_cast<Index>(noise.uniform() * static_cast<double>(left.size()));
      y(k) = noise.uniform() < 0.5 ? -left(from) : left(from);
    }
    return y;
  }
  // Student's t, scaled so that the residual variance is the one seen.
  [[nodiscard]] VectorXd surrogate(closure::NoiseStream& noise, double variance) const {
    VectorXd y(weights_.size());
    for (Index k = 0; k < y.size(); ++k) y(k) = std::sqrt(std::max(1.0, variance)) * student(noise, at(k));
    return y;
  }

  // size, per_kelvin and mean with the candidate in the model.
  void estimate(const VectorXd& y, const Best& best, Change& out) const {
    const Candidate& chosen = candidates_[best.candidate];
    const double excess = std::sqrt(std::max(1.0, best.variance));
    out.scatter = std::sqrt(best.variance);
    out.size = chosen.direction.dot(without_basis(y)) / chosen.length;
    out.size_std = excess / chosen.length;
    const VectorXd left = out.is_significant ? VectorXd(y - out.size * chosen.regressor) : y;
    out.mean = left.dot(weights_) / weights_.squaredNorm();
    if (basis_.size() < 2) return;
    out.per_kelvin = left.dot(basis_[1]) / temperature_length_;
    out.per_kelvin_std = excess / temperature_length_;
  }

 private:
  [[nodiscard]] const FlightValue& at(Index k) const { return values_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] double freedom() const {
    return static_cast<double>(values_.size()) - static_cast<double>(basis_.size()) - 1.0;
  }

  // A flight's few blocks give both value and std, so their errors are correlated: weights from these stds would be
  // largest for values with large errors. Therefore variances are shrunk towards their median.
  void share_variances() {
    std::vector<double> variances;
    for (const FlightValue& value : values_) variances.push_back(value.std * value.std);
    const double typical = median(variances);
    for (FlightValue& value : values_) {
      const double own = value.degrees_of_freedom;
      if (!(own > 0.0)) continue;
      value.std = std::sqrt((own * value.std * value.std + kSharedFreedom * typical) / (own + kSharedFreedom));
      value.degrees_of_freedom = own + kSharedFreedom;
    }
  }

  [[nodiscard]] VectorXd without_basis(VectorXd y) const {
    for (const VectorXd& b : basis_) y -= b.dot(y) * b;
    return y;
  }

  void add_temperature(const Conditions& conditions) {
    if (conditions.temperature_c.empty()) return;
    VectorXd kelvin(weights_.size());
    for (Index k = 0; k < kelvin.size(); ++k) kelvin(k) = conditions.temperature_c[at(k).flight];
    kelvin.array() -= kelvin.mean();
    if (kelvin.norm() < kLeastTemperature_k * std::sqrt(static_cast<double>(kelvin.size()))) return;
    const VectorXd own = without_basis(weights_.cwiseProduct(kelvin));
    temperature_length_ = own.norm();
    if (temperature_length_ > 0.0) basis_.emplace_back(own / temperature_length_);
  }

  void add(ChangeKind kind, std::size_t first_flight, const VectorXd& course) {
    const VectorXd regressor = weights_.cwiseProduct(course), own = without_basis(regressor);
    // Compared with what the constant alone leaves: temperature must not explain the candidate.
    const VectorXd varying = regressor - basis_[0].dot(regressor) * basis_[0];
    if (!(own.squaredNorm() > kLeastOwnShare * varying.squaredNorm())) return;
    candidates_.push_back({kind, first_flight, own.normalized(), own.norm(), regressor});
  }

  void add_candidates(const Conditions& conditions) {
    const std::size_t n = values_.size();
    const std::size_t stride = 1 + n / kMostSteps;
    for (std::size_t first = kLeastFlightsBeside; first + kLeastFlightsBeside <= n; first += stride) {
      VectorXd after = VectorXd::Zero(static_cast<Index>(n));
      after.tail(static_cast<Index>(n - first)).setOnes();
      add(ChangeKind::kStep, values_[first].flight, after);
    }
    VectorXd day(static_cast<Index>(n));
    for (std::size_t k = 0; k < n; ++k) day(static_cast<Index>(k)) = conditions.day[values_[k].flight];
    day.array() -= day(0);
    if (day.maxCoeff() > 0.0) add(ChangeKind::kTrend, 0, day);
  }

  [[nodiscard]] static double student(closure::NoiseStream& noise, const FlightValue& value) {
    const double z = noise.gaussian();
    const int freedom = static_cast<int>(std::lround(value.degrees_of_freedom));
    if (freedom <= 0) return z;
    double squares = 0.0;
    for (int i = 0; i < freedom; ++i) squares += std::pow(noise.gaussian(), 2);
    return z / std::sqrt(squares / freedom);
  }

  FlightSeries values_;
  VectorXd weights_;
  std::vector<VectorXd> basis_;  // orthonormal: constant, temperature
  double temperature_length_ = 0.0;
  std::vector<Candidate> candidates_;
};

// The largest statistics of the family in series without a change, ascending: of errors with Student's distribution,
// and of the flights' own residuals.
struct ChanceLevels {
  std::vector<double> student, resampled;

  // The larger of both, for a statistic.
  [[nodiscard]] double chance(double statistic) const {
    const auto above = [&](const std::vector<double>& levels) {
      return levels.end() - std::lower_bound(levels.begin(), levels.end(), statistic);
    };
    return static_cast<double>(std::max(above(student), above(resampled)) + 1) / (kSurrogates + 1);
  }
};

ChanceLevels chance_levels(const std::vector<Design>& designs, const std::vector<Best>& best) {
  closure::NoiseStream noise(kSeed);
  std::vector<VectorXd> left;
  for (std::size_t i = 0; i < designs.size(); ++i)
    left.emplace_back(designs[i].is_tested() ? designs[i].left_by(best[i]) : VectorXd());
  ChanceLevels out;
  for (int s = 0; s < kSurrogates; ++s) {
    double student = 0.0, resampled = 0.0;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      if (!designs[i].is_tested()) continue;
      student = std::max(student, designs[i].best(designs[i].surrogate(noise, best[i].variance)).statistic);
      resampled = std::max(resampled, designs[i].best(Design::resampled(noise, left[i])).statistic);
    }
    out.student.push_back(student);
    out.resampled.push_back(resampled);
  }
  std::sort(out.student.begin(), out.student.end());
  std::sort(out.resampled.begin(), out.resampled.end());
  return out;
}

}  // namespace

std::vector<Change> test_changes(const Conditions& conditions, const std::vector<FlightSeries>& family, double level) {
  std::vector<Change> out(family.size());
  std::vector<Design> designs;
  std::vector<Best> best;
  for (const FlightSeries& series : family) {
    designs.emplace_back(conditions, series);
    best.push_back(designs.back().is_tested() ? designs.back().best(designs.back().weighted()) : Best{});
  }
  const ChanceLevels levels = chance_levels(designs, best);
  for (std::size_t i = 0; i < family.size(); ++i) {
    if (!designs[i].is_tested()) continue;
    const VectorXd y = designs[i].weighted();
    const Candidate& chosen = designs[i].candidate(best[i].candidate);
    Change& change = out[i];
    change.is_tested = true;
    change.chance = levels.chance(best[i].statistic);
    change.is_significant = change.chance <= level;
    change.kind = chosen.kind;
    change.first_flight = chosen.first_flight;
    const ChangeKind other = chosen.kind == ChangeKind::kStep ? ChangeKind::kTrend : ChangeKind::kStep;
    change.kind_is_clear = best[i].statistic - std::max(0.0, designs[i].best(y, other).statistic) > kClearKind;
    designs[i].estimate(y, best[i], change);
  }
  return out;
}

}  // namespace core::monitoring
