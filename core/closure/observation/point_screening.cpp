#include "core/closure/observation/point_screening.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/median.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

constexpr double kLeastFreedom = 0.05;  // smallest 1 - leverage
constexpr int kSpare = 2;               // points that a fit needs beyond its unknowns along each axis
constexpr double kLarge = 0.4;          // extent / image height: in larger regions a readout makes motion quadratic
using Terms = Eigen::Matrix<double, 6, 1>;
constexpr double kRidge = 1e-9;

// Deviations of one region's points from the smooth motion of the other points, in sigmas.
class RegionScreen {
 public:
  RegionScreen(const ObservationRecord& record, std::vector<Eigen::Index> points)
      : points_(std::move(points)),
        in_fit_(points_.size(), 1),
        sigma_px_(points_.size()),
        terms_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(points_.size()), 6)),
        u_(record.n_frames(), static_cast<Eigen::Index>(points_.size())),
        v_(u_.rows(), u_.cols()),
        leverage_(Eigen::VectorXd::Zero(u_.cols())) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto c = static_cast<Eigen::Index>(i);
      sigma_px_[i] = record.sigma_px[static_cast<std::size_t>(points_[i])];
      terms_(c, 0) = 1.0;
      terms_(c, 1) = take(record.u_px.col(points_[i]), u_.col(c));
      terms_(c, 2) = take(record.v_px.col(points_[i]), v_.col(c));
    }
    set_terms(kLarge * record.height_px);
    settle();
  }

  // Excludes bad points from the fit; returns their scatter over the region's median, 1 for the others.
  std::vector<double> excess() {
    std::vector<double> out(points_.size(), 1.0);
    while (n_in_fit() > least_in_fit()) {
      compare();
      std::size_t worst = 0;
      for (std::size_t i = 1; i < points_.size(); ++i) {
        if (in_fit_[i] != 0 && (in_fit_[worst] == 0 || scatter_[i] > scatter_[worst])) worst = i;
      }
      in_fit_[worst] = 0;
      compare();
      const double over = own_scatter(worst) / std::max(1.0, median_scatter());
      if (!(over > kDoubtful)) {
        in_fit_[worst] = 1;
        break;
      }
      out[worst] = over;
    }
    compare();
    return out;
  }

  // Outlying positions, as frame and index in points(), compared with the fit to the other points.
  [[nodiscard]] std::vector<std::pair<Eigen::Index, std::size_t>> far_positions() {
    std::vector<std::pair<Eigen::Index, std::size_t>> out;
    for (Eigen::Index k = 0; k < u_.rows(); ++k) {
      std::vector<char> seen = in_fit_;
      for (std::size_t worst = farthest(k, seen); worst < points_.size(); worst = farthest(k, seen)) {
        out.emplace_back(k, worst);
        seen[worst] = 0;
        compare_frame(k, seen);
      }
    }
    return out;
  }
  [[nodiscard]] const std::vector<Eigen::Index>& points() const noexcept { return points_; }

 private:
  // Subtracts the mean of a series and returns it.
  static double take(const Eigen::VectorXd& series, Eigen::Ref<Eigen::VectorXd> out) {
    double sum = 0.0, n = 0.0;
    for (const double value : series) {
      if (std::isfinite(value)) sum += value, n += 1.0;
    }
    const double mean = sum / n;
    out = series.array() - mean;
    return mean;
  }

  // A jump shifts the mean of a point: its median deviation is a position offset, not motion, and is removed.
  void settle() {
    for (int round = 0; round < 2; ++round) {
      compare();
      for (Eigen::Index c = 0; c < u_.cols(); ++c) {
        const double scale = sigma(c) * std::sqrt(std::max(1.0 - leverage_(c), kLeastFreedom));
        for (auto [series, off] : {std::pair{&u_, &off_u_}, std::pair{&v_, &off_v_}}) {
          std::vector<double> seen;
          for (const double value : off->col(c)) {
            if (std::isfinite(value)) seen.push_back(value);
          }
          if (!seen.empty()) series->col(c).array() -= scale * median(std::move(seen));
        }
      }
    }
  }

  void set_terms(double large_px) {
    double extent_px = 0.0;
    for (Eigen::Index axis = 1; axis < 3; ++axis) {
      extent_px = std::max(extent_px, terms_.col(axis).maxCoeff() - terms_.col(axis).minCoeff());
      terms_.col(axis).array() -= terms_.col(axis).mean();
      const double norm = terms_.col(axis).norm();
      if (norm > 0.0) terms_.col(axis) /= norm;
    }
    if (extent_px > large_px) {
      n_terms_ = 6;
      terms_.col(3) = terms_.col(1).cwiseAbs2();
      terms_.col(4) = terms_.col(1).cwiseProduct(terms_.col(2));
      terms_.col(5) = terms_.col(2).cwiseAbs2();
    }
  }

  [[nodiscard]] int least_in_fit() const noexcept { return n_terms_ + kSpare; }
  [[nodiscard]] int n_in_fit() const { return static_cast<int>(std::count(in_fit_.begin(), in_fit_.end(), 1)); }

  void compare() {
    off_u_.setConstant(u_.rows(), u_.cols(), kNan);
    off_v_ = off_u_;
    for (Eigen::Index k = 0; k < u_.rows(); ++k) compare_frame(k, in_fit_);
    scatter_.assign(points_.size(), 0.0);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (const auto* off : {&off_u_, &off_v_}) {  // the worse axis: a point may be lost along one axis of an edge
        std::vector<double> all;
        for (const double value : off->col(static_cast<Eigen::Index>(i))) {
          if (std::isfinite(value)) all.push_back(std::abs(value));
        }
        const double middle = kSigmaPerMad * median(std::move(all));
        if (std::isfinite(middle)) scatter_[i] = std::max(scatter_[i], middle);
      }
    }
  }

  // Studentised deviations in one frame; points with fit 0 are predicted by the others alone.
  void compare_frame(Eigen::Index k, const std::vector<char>& fit) {
    off_u_.row(k).setConstant(kNan), off_v_.row(k).setConstant(kNan);
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Identity() * kRidge;
    Eigen::Matrix<double, 6, 2> right = Eigen::Matrix<double, 6, 2>::Zero();
    int n = 0;
    for (Eigen::Index c = 0; c < u_.cols(); ++c) {
      if (fit[static_cast<std::size_t>(c)] == 0 || !std::isfinite(u_(k, c) + v_(k, c))) continue;
      const double weight = 1.0 / (sigma(c) * sigma(c));
      const Terms a = terms_.row(c);
      normal += weight * a * a.transpose();
      right.col(0) += weight * u_(k, c) * a;
      right.col(1) += weight * v_(k, c) * a;
      ++n;
    }
    if (n < least_in_fit()) return;
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(normal);
    const Eigen::Matrix<double, 6, 2> smooth = solver.solve(right);
    for (Eigen::Index c = 0; c < u_.cols(); ++c) {
      if (!std::isfinite(u_(k, c) + v_(k, c))) continue;
      const Terms a = terms_.row(c);
      const double leverage = a.dot(solver.solve(a)) / (sigma(c) * sigma(c));
      leverage_(c) = leverage;
      const double variance = fit[static_cast<std::size_t>(c)] != 0 ? 1.0 - leverage : 1.0 + leverage;
      if (!(variance > kLeastFreedom)) continue;
      const double scale = 1.0 / (sigma(c) * std::sqrt(variance));
      off_u_(k, c) = (u_(k, c) - a.dot(smooth.col(0))) * scale;
      off_v_(k, c) = (v_(k, c) - a.dot(smooth.col(1))) * scale;
    }
  }

  [[nodiscard]] double sigma(Eigen::Index c) const { return sigma_px_[static_cast<std::size_t>(c)]; }

  // Scatter of a point that is predicted by the others, without the contribution of their scatter.
  [[nodiscard]] double own_scatter(std::size_t i) const {
    const double others = median_scatter(), h = leverage_(static_cast<Eigen::Index>(i));
    return std::sqrt(std::max(0.0, (1.0 + h) * scatter_[i] * scatter_[i] - h * others * others));
  }

  [[nodiscard]] double median_scatter() const {
    std::vector<double> all;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (in_fit_[i] != 0) all.push_back(scatter_[i]);
    }
    return median(std::move(all));
  }

  // Index of the farthest point of the fit beyond kFar; the number of points if there is none.
  [[nodiscard]] std::size_t farthest(Eigen::Index k, const std::vector<char>& fit) const {
    std::size_t worst = points_.size();
    double most = kFar;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto c = static_cast<Eigen::Index>(i);
      const double off = std::hypot(off_u_(k, c), off_v_(k, c)) / std::max(1.0, scatter_[i]);
      if (fit[i] != 0 && off > most) most = off, worst = i;
    }
    return worst;
  }

  std::vector<Eigen::Index> points_;
  std::vector<char> in_fit_;
  std::vector<double> sigma_px_;
  Eigen::MatrixXd terms_;  // 1, u, v (centred, unit norm); in large regions also their products, else zero
  int n_terms_ = 3;
  Eigen::MatrixXd u_, v_;  // frames x points, px about each point's median
  Eigen::MatrixXd off_u_, off_v_;
  Eigen::VectorXd leverage_;  // of the last frame compared
  std::vector<double> scatter_;
};

struct Found {
  std::size_t n_doubtful = 0, n_bad = 0, n_far = 0;
  double most = 0.0;
};

void screen_region(ObservationRecord& record, std::vector<Eigen::Index> points, Found& found) {
  RegionScreen screen(record, std::move(points));
  const std::vector<double> excess = screen.excess();
  for (const auto& [frame, i] : screen.far_positions()) {
    record.u_px(frame, screen.points()[i]) = record.v_px(frame, screen.points()[i]) = kNan;
    ++found.n_far;
  }
  for (std::size_t i = 0; i < excess.size(); ++i) {
    if (!(excess[i] > 1.0)) continue;
    const Eigen::Index point = screen.points()[i];
    found.most = std::max(found.most, excess[i]);
    ++(excess[i] > kBad ? found.n_bad : found.n_doubtful);
    record.sigma_px[static_cast<std::size_t>(point)] *= excess[i];
    if (excess[i] > kBad) record.u_px.col(point).setConstant(kNan), record.v_px.col(point).setConstant(kNan);
  }
}

}  // namespace

std::vector<std::string> screen_points(ObservationRecord& record) {
  std::vector<std::vector<Eigen::Index>> of_region(record.regions.size());
  for (Eigen::Index j = 0; j < record.n_points(); ++j)
    of_region[record.region_of_point[static_cast<std::size_t>(j)]].push_back(j);
  Found found;
  for (std::vector<Eigen::Index>& points : of_region) {
    if (points.size() >= kLeastPointsToScreen) screen_region(record, std::move(points), found);
  }
  std::vector<std::string> words;
  if (found.n_bad + found.n_doubtful > 0)
    words.push_back("points that do not move with their region, with up to " + std::to_string(std::lround(found.most)) +
                    " times the scatter of the others: " + std::to_string(found.n_bad) + " excluded, " +
                    std::to_string(found.n_doubtful) + " with reduced weight");
  if (found.n_far > 0)
    words.push_back(std::to_string(found.n_far) +
                    " single positions excluded: far from the position predicted by their region");
  return words;
}

}  // namespace core::closure
