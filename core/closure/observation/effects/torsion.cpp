#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/kinds/family_effect.h"
#include "core/closure/observation/kinds/learned_pattern.h"
#include "core/closure/observation/kinds/materiality.h"

namespace core::closure {
namespace {

// Distances of the structure's points from an upright axis, in units of the focal length; zero for all others. aside:
// of the axis from the structure's middle.
Eigen::VectorXd from_axis(const ObservationRecord& record, const PointGeometry& geometry, double aside) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(geometry.x.size());
  double low = 0.0, high = 0.0;
  bool any = false;
  for (Eigen::Index j = 0; j < out.size(); ++j) {
    if (!makes_channel(record.regions[record.region_of_point[static_cast<std::size_t>(j)]].role)) continue;
    const double x = geometry.x(j);
    low = any ? std::min(low, x) : x, high = any ? std::max(high, x) : x;
    any = true;
  }
  for (Eigen::Index j = 0; j < out.size(); ++j) {
    if (makes_channel(record.regions[record.region_of_point[static_cast<std::size_t>(j)]].role))
      out(j) = geometry.x(j) - 0.5 * (low + high) - aside;
  }
  return out;
}

// px per rad, 2 points x regions: each region turned about the axis. A point at a distance d from it goes away by d
// times the angle, and its image moves towards the principal point by the same share.
Eigen::MatrixXd turned_regions(const ObservationRecord& record, const PointGeometry& geometry, double aside) {
  const Eigen::VectorXd distance = from_axis(record, geometry, aside);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * distance.size(), static_cast<Eigen::Index>(record.regions.size()));
  for (Eigen::Index j = 0; j < distance.size(); ++j) {
    const auto region = static_cast<Eigen::Index>(record.region_of_point[static_cast<std::size_t>(j)]);
    out.block<2, 1>(2 * j, region) = -geometry.alpha_px * distance(j) * Eigen::Vector2d(geometry.x(j), geometry.y(j));
  }
  return out;
}

// The pattern holds where the points are on average; they are where the camera's and the structure's motion has
// carried them, and a turn also brings points nearer to the middle line (second order).
class TorsionInModel final : public LearnedPattern {
 public:
  using LearnedPattern::LearnedPattern;
  [[nodiscard]] std::unique_ptr<EffectInModel> clone() const override {
    return std::make_unique<TorsionInModel>(*this);
  }
  void set_places(const ObservationRecord& record, const PointGeometry& geometry) override {
    geometry_ = geometry;
    distance_ = from_axis(record, geometry, aside_);
    const Eigen::MatrixXd fields = turned_regions(record, geometry, aside_);
    if (turn_of_region_.size() == 0) {
      learn_turns(fields);
    } else {
      form(fields);
    }
    turn_.resize(distance_.size());
    for (Eigen::Index j = 0; j < turn_.size(); ++j) {
      turn_(j) = turn_of_region_(static_cast<Eigen::Index>(record.region_of_point[static_cast<std::size_t>(j)]));
    }
  }
  [[nodiscard]] bool is_refined() const override { return true; }
  // The pattern was learned where the points are on average. One step of Gauss and Newton for the turn of each region
  // and the place of the axis, without what the model's columns take.
  void refine(const FitView& fit, const Eigen::RowVectorXd& amplitude) override {
    const double squares = amplitude.squaredNorm();
    if (!(squares > 0.0)) return;
    const Eigen::MatrixXd turned = turned_regions(fit.record, fit.model.geometry(), aside_);
    Eigen::MatrixXd columns(turned.rows(), turned.cols() + 1);
    for (Eigen::Index j = 0; j < turn_.size(); ++j) {
      columns.block<2, 1>(2 * j, turned.cols()) =
          geometry_.alpha_px * turn_(j) * Eigen::Vector2d(geometry_.x(j), geometry_.y(j));
    }
    columns.leftCols(turned.cols()) = turned;
    const Eigen::MatrixXd whitened = fit.model.whitened(columns), &q = fit.model.q_low();
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver;
    solver.setThreshold(kLeastBeside);
    solver.compute(whitened - q * (q.transpose() * whitened));
    const Eigen::VectorXd change = solver.solve(fit.model.residual() * amplitude.transpose() / squares);
    turn_of_region_ += change.head(turned.cols());
    aside_ += change(turned.cols());
    form(turned_regions(fit.record, fit.model.geometry(), aside_));
  }
  [[nodiscard]] bool has_second_order() const override { return true; }
  void remove_second_order(const PatternCourse& course, const ObservationRecord& record,
                           Eigen::MatrixXd& positions) const override {
    const double alpha = geometry_.alpha_px;
    for (Eigen::Index j = 0; j < turn_.size(); ++j) {
      if (turn_(j) == 0.0) continue;
      const double later = course.readout_frames * (geometry_.share(j) - course.mean_share);
      const Eigen::Vector2d principal(record.cx_px, record.cy_px), mean(geometry_.x(j), geometry_.y(j));
      for (Eigen::Index k = 0; k < positions.cols(); ++k) {
        const double angle = turn_(j) * (course.amplitude(k) + later * course.rate(k)), away = angle * distance_(j);
        auto at = positions.block<2, 1>(2 * j, k);
        const Eigen::Vector2d flat = (1.0 + away) * (at - principal);
        at = principal + flat - alpha * away * mean;
        at.x() += 0.5 * alpha * distance_(j) * angle * angle;
      }
    }
  }

 private:
  void learn_turns(const Eigen::MatrixXd& fields) {
    turn_of_region_ = Eigen::VectorXd::Zero(fields.cols());
    for (Eigen::Index r = 0; r < fields.cols(); ++r) {
      const double squares = fields.col(r).squaredNorm();
      if (squares > 0.0) turn_of_region_(r) = fields.col(r).dot(*pattern()) / squares;
    }
  }
  void form(const Eigen::MatrixXd& fields) {
    Eigen::VectorXd pattern = fields * turn_of_region_;
    turn_of_region_ *= std::sqrt(static_cast<double>(pattern.size())) / pattern.norm();
    set_pattern(std::move(pattern));
  }

  PointGeometry geometry_;
  double aside_ = 0.0;              // of the axis from the structure's middle
  Eigen::VectorXd distance_;        // as from_axis()
  Eigen::VectorXd turn_of_region_;  // rad per unit of the amplitude
  Eigen::VectorXd turn_;            // of each point's region
};

// Regions turn about the upright axis, each by its own share: one side comes nearer, the other goes away. Observable by
// the perspective of wide regions; confused with the camera's yaw, which turns all regions and the background alike.
class Torsion final : public FamilyEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"torsion"}; }
  [[nodiscard]] std::string name() const override { return "torsion"; }
  // Of each region of the structure.
  [[nodiscard]] Eigen::MatrixXd fields(const ObservationRecord& record, const PointGeometry& geometry) const override {
    const Eigen::MatrixXd all = turned_regions(record, geometry, 0.0);
    std::vector<Eigen::Index> used;
    for (Eigen::Index c = 0; c < all.cols(); ++c) {
      if (!all.col(c).isZero(0.0)) used.push_back(c);
    }
    return all(Eigen::all, used);
  }
  [[nodiscard]] NotObservable when_absent() const override {
    return {name(), "no region of the structure is seen", "declare the floors"};
  }
  [[nodiscard]] std::unique_ptr<EffectInModel> in_model(RungSet band, const Eigen::VectorXd& pattern) const override {
    return std::make_unique<TorsionInModel>(LearnedName{id(), name()}, band, pattern);
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_torsion() { return std::make_unique<Torsion>(); }

}  // namespace core::closure
