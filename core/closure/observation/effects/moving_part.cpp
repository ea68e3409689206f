#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/closure/observation/effect.h"
#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/follows_motion.h"
#include "core/closure/observation/kinds/learned_pattern.h"
#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

constexpr std::size_t kLeastOnSide = 2;  // on either side of the division
constexpr int kRounds = 2;
constexpr double kOfPlace = 0.5;  // of what is left in its region beyond the noise, explained by one part

using Points = std::vector<Eigen::Index>;

// Some points of a region move together beside the others: values, in the order of their size, divided where most of
// their squares lie between the two groups. True: of the points whose value lies above.
std::vector<char> divided(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return values(a) < values(b); });
  const double mean = values.mean();
  double below = 0.0, most = -1.0;
  std::size_t at = kLeastOnSide;
  for (std::size_t n = 1; n < order.size(); ++n) {
    below += values(order[n - 1]) - mean;
    if (n < kLeastOnSide || order.size() - n < kLeastOnSide) continue;
    const double between = below * below * (1.0 / static_cast<double>(n) + 1.0 / static_cast<double>(order.size() - n));
    if (between > most) most = between, at = n;
  }
  std::vector<char> out(order.size(), 0);
  for (std::size_t n = at; n < order.size(); ++n) out[static_cast<std::size_t>(order[n])] = 1;
  return out;
}

struct Part {
  Eigen::VectorXd pattern;  // px; empty: none
  PatternGain found;
};

// A part of a region that moves by itself, along the region's axis or across it. Observable by the points on the other
// part; confused with nothing but a region declared too wide.
class MovingPartCandidate final : public EffectCandidate {
 public:
  MovingPartCandidate(EffectId id, std::string name, const FitView& fit)
      : id_(std::move(id)), name_(std::move(name)), fit_(fit), points_(fit.record.regions.size()) {
    for (std::size_t j = 0; j < fit.record.region_of_point.size(); ++j)
      points_[fit.record.region_of_point[j]].push_back(static_cast<Eigen::Index>(j));
  }
  [[nodiscard]] double gain(const TestedResidual& residual) const override { return best(residual.moments).found.gain; }
  double find(const TestedResidual& residual) override {
    part_ = best(residual.moments);
    of_place_ = share_of_place(residual.moments);
    return part_.found.gain;
  }
  [[nodiscard]] double material_share() const override { return material_of(part_.found.band, fit_, kLearnedBar); }
  [[nodiscard]] bool is_learned() const override { return true; }
  [[nodiscard]] std::optional<double> free_gain(const TestedResidual& residual) const override {
    return fit_.held_out.of_learned_in(part_.found.band, residual.moments);
  }
  [[nodiscard]] Objection objection(const TestedResidual& /*residual*/) const override {
    if (part_.pattern.size() == 0) return {};
    if (of_place_ < kOfPlace)
      return {"its region moves in many ways: this one is " + std::to_string(std::lround(100.0 * of_place_)) +
              " % of them"};
    const Eigen::VectorXd whitened = fit_.model.whitened(part_.pattern);
    const Objection common = follows_motion(fit_, whitened, part_.found.band);
    return common.words.empty() ? follows_regions(fit_, whitened, part_.found.band) : common;
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> adopted() const override {
    return std::make_unique<LearnedPattern>(LearnedName{id_, name_}, part_.found.band, part_.pattern);
  }

 private:
  [[nodiscard]] Part best(const ResidualMoments& moments) const {
    Part out;
    for (const Points& points : points_) {
      for (const Eigen::Index axis : {0, 1}) {
        Part part = learned(points, axis, moments);
        if (part.pattern.size() > 0 && part.found.gain > out.found.gain) out = std::move(part);
      }
    }
    return out;
  }
  // Of the squares that its region's residual holds beyond the noise, in its rungs.
  [[nodiscard]] double share_of_place(const ResidualMoments& moments) const {
    if (part_.pattern.size() == 0) return 0.0;
    const RungSet band = part_.found.band;
    const Eigen::MatrixXd all = fit_.held_out.sum_over(band, moments);
    const double freedom =
        static_cast<double>(fit_.record.n_frames()) * (band == kAllRungs ? 1.0 : fit_.held_out.share_of(band));
    double place = 0.0;
    for (const Points& points : points_) {
      const auto moves = [&](Eigen::Index j) { return !part_.pattern.segment<2>(2 * j).isZero(0.0); };
      if (std::none_of(points.begin(), points.end(), moves)) continue;
      for (const Eigen::Index j : points) {
        for (const Eigen::Index row : {2 * j, 2 * j + 1})
          place += all(row, row) - freedom * (1.0 - fit_.model.q_high().row(row).squaredNorm());
      }
    }
    const Eigen::VectorXd g = pattern_beside(fit_.model, fit_.model.whitened(part_.pattern)).above;
    const double one = g.dot(all * g) - freedom;
    return place > 0.0 ? one / place : 1.0;
  }
  [[nodiscard]] Part learned(const Points& points, Eigen::Index axis, const ResidualMoments& moments) const {
    Part out;
    if (points.size() < 2 * kLeastOnSide) return out;
    Points rows;
    for (const Eigen::Index j : points) rows.push_back(2 * j + axis);
    RungSet band = kAllRungs;
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::MatrixXd within = fit_.held_out.sum_over(band, moments)(rows, rows);
      Eigen::VectorXd leading = Eigen::VectorXd::Zero(fit_.model.weight().size());
      leading(rows) = leading_pattern(within);
      const std::vector<char> above = divided(fit_.model.in_px(leading)(rows));
      out.pattern = Eigen::VectorXd::Zero(fit_.model.weight().size());
      for (std::size_t i = 0; i < rows.size(); ++i) out.pattern(rows[i]) = above[i] != 0 ? 1.0 : 0.0;
      const Eigen::VectorXd whitened = fit_.model.whitened(out.pattern);
      out.found = fit_.held_out.of_pattern(pattern_beside(fit_.model, whitened), moments);
      band = out.found.band;
    }
    return out;
  }

  EffectId id_;
  std::string name_;
  const FitView fit_;
  std::vector<Points> points_;  // of each region
  Part part_;
  double of_place_ = 0.0;
};

class MovingPart final : public ObservationEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"moving_part"}; }
  [[nodiscard]] std::string name() const override { return "moving part"; }
  [[nodiscard]] std::size_t n_parameters() const override { return 2; }
  [[nodiscard]] std::optional<NotObservable> obstacle(const FitView& /*fit*/, bool /*is_adopted*/) const override {
    return std::nullopt;
  }
  [[nodiscard]] std::unique_ptr<EffectCandidate> candidate(const FitView& fit) const override {
    return std::make_unique<MovingPartCandidate>(id(), name(), fit);
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_moving_part() { return std::make_unique<MovingPart>(); }

}  // namespace core::closure
