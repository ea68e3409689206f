#include "core/geometry/gyro_readout.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/geometry/gyro_attitude.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t kLeastPairs = 8, kLeastPoints = 8;
constexpr double kLeastTurn_rad = 1e-3;  // rms per frame: below it, a frame's rotation is lost in the tracks' noise
constexpr double kOffsetStep_s = 2e-3;
constexpr int kRounds = 30;
enum Unknown : Index { kReadout, kOffset, kFocal, kBias, kAxes = kBias + 3, kUnknowns = kAxes + 3 };
using Vector = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
constexpr double kSteps[kUnknowns] = {1e-5, 1e-5, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4};

struct State {
  Vector p = Vector::Zero();  // focal as logarithm; axes as a small rotation after `axes`
  Quaterniond axes = Quaterniond::Identity();
};

class Problem {
 public:
  Problem(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro, const GyroReadoutConfig& config)
      : pairs_(pairs), gyro_(gyro), config_(config) {}

  // Residuals of one pair, u and v in turn.
  void residuals(const State& state, const GyroAttitude& attitude, const FramePair& pair,
                 std::vector<double>& out) const {
    const double f = std::exp(state.p[kFocal]), readout_s = state.p[kReadout], offset_s = state.p[kOffset];
    const Quaterniond axes = turn(state.p.segment<3>(kAxes)) * state.axes;
    out.clear();
    for (const PointPair& point : pair.points) {
      const Vector3d bearing((point.from.u - config_.cx_px) / f, (point.from.v - config_.cy_px) / f, 1.0);
      const Quaterniond first = attitude(pair.from_s + offset_s + readout_s * point.from_fraction);
      const Quaterniond second = attitude(pair.to_s + offset_s + readout_s * point.to_fraction);
      const Vector3d seen = axes * (second.conjugate() * (first * (axes.conjugate() * bearing)));
      out.push_back(config_.cx_px + f * seen.x() / seen.z() - point.to.u);
      out.push_back(config_.cy_px + f * seen.y() / seen.z() - point.to.v);
    }
  }
  [[nodiscard]] std::vector<std::vector<double>> residuals(const State& state) const {
    const GyroAttitude attitude(gyro_, state.p.segment<3>(kBias));
    std::vector<std::vector<double>> all(pairs_.size());
    for (std::size_t k = 0; k < pairs_.size(); ++k) residuals(state, attitude, pairs_[k], all[k]);
    return all;
  }
  [[nodiscard]] const std::vector<FramePair>& pairs() const noexcept { return pairs_; }

 private:
  const std::vector<FramePair>& pairs_;
  const std::vector<GyroSample>& gyro_;
  const GyroReadoutConfig& config_;
};

double robust_scale(const Problem& problem, const std::vector<std::vector<double>>& residuals) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    if (problem.pairs()[k].held_out) continue;
    for (const double r : residuals[k]) sizes.push_back(std::abs(r));
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(1e-6, 1.4826 * *middle);
}

double cost(const Problem& problem, const std::vector<std::vector<double>>& residuals, double scale) {
  double sum = 0.0;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    if (problem.pairs()[k].held_out) continue;
    for (const double r : residuals[k]) sum += std::log1p(r * r / (4.0 * scale * scale));
  }
  return sum;
}

struct Normal {
  Matrix hessian = Matrix::Zero(), scores = Matrix::Zero();  // scores: sum over pairs of the gradient's outer product
  Vector gradient = Vector::Zero();
  int n_pairs = 0;
};

Normal linearise(const Problem& problem, const State& state, const std::vector<std::vector<double>>& residuals,
                 double scale) {
  std::vector<std::vector<std::vector<double>>> moved;
  for (Index i = 0; i < kUnknowns; ++i) {
    State ahead = state;
    ahead.p[i] += kSteps[i];
    moved.push_back(problem.residuals(ahead));
  }
  Normal normal;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    if (problem.pairs()[k].held_out) continue;
    Vector score = Vector::Zero();
    for (std::size_t j = 0; j < residuals[k].size(); ++j) {
      const double r = residuals[k][j], weight = 1.0 / (1.0 + r * r / (4.0 * scale * scale));
      Vector slope;
      for (Index i = 0; i < kUnknowns; ++i) slope[i] = (moved[static_cast<std::size_t>(i)][k][j] - r) / kSteps[i];
      normal.hessian += weight * slope * slope.transpose();
      score += weight * r * slope;
    }
    normal.gradient += score;
    normal.scores += score * score.transpose();
    ++normal.n_pairs;
  }
  return normal;
}

// Unknowns that are held get a row of their own.
void hold(Normal& normal, const std::vector<Index>& held) {
  for (const Index i : held) {
    normal.hessian.row(i).setZero();
    normal.hessian.col(i).setZero();
    normal.hessian(i, i) = 1.0;
    normal.gradient[i] = 0.0;
    normal.scores.row(i).setZero();
    normal.scores.col(i).setZero();
  }
}

// Levenberg-Marquardt; returns the covariance at the end.
Matrix minimise(const Problem& problem, const std::vector<Index>& held, State& state) {
  std::vector<std::vector<double>> residuals = problem.residuals(state);
  double damping = 1e-3, scale = robust_scale(problem, residuals);
  Normal normal;
  for (int round = 0; round < kRounds && damping < 1e6; ++round) {
    normal = linearise(problem, state, residuals, scale);
    hold(normal, held);
    const double before = cost(problem, residuals, scale);
    for (; damping < 1e6; damping *= 10.0) {
      Matrix raised = normal.hessian;
      raised.diagonal() *= 1.0 + damping;
      State next = state;
      next.p -= raised.ldlt().solve(normal.gradient);
      std::vector<std::vector<double>> after = problem.residuals(next);
      const double now = cost(problem, after, scale);
      if (!(now < before)) continue;
      next.axes = (turn(next.p.segment<3>(kAxes)) * next.axes).normalized();
      next.p.segment<3>(kAxes).setZero();
      state = next;
      residuals = std::move(after);
      damping = std::max(1e-9, 0.1 * damping);
      if (before - now < 1e-9 * before) damping = 1e7;
      break;
    }
    scale = robust_scale(problem, residuals);
  }
  normal = linearise(problem, state, residuals, scale);
  hold(normal, held);
  const Matrix inverse = normal.hessian.ldlt().solve(Matrix::Identity());
  const double small_sample =
      static_cast<double>(normal.n_pairs) / std::max(1, normal.n_pairs - static_cast<int>(kUnknowns));
  return small_sample * inverse * normal.scores * inverse;
}

// Rotation of the camera between two frames, first order, by least squares over the points.
Vector3d image_rotation(const FramePair& pair, const GyroReadoutConfig& config, double focal_px) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const PointPair& point : pair.points) {
    const double x = (point.from.u - config.cx_px) / focal_px, y = (point.from.v - config.cy_px) / focal_px;
    const Vector3d u(x * y, -(1.0 + x * x), y), v(1.0 + y * y, -x * y, -x);
    normal += u * u.transpose() + v * v.transpose();
    right += u * (point.to.u - point.from.u) / focal_px + v * (point.to.v - point.from.v) / focal_px;
  }
  return normal.ldlt().solve(right);
}

// Axes and clock offset at which the gyro turns as the picture does (Wahba's problem, solved by SVD).
State first_guess(const Problem& problem, const std::vector<GyroSample>& gyro, const GyroReadoutConfig& config,
                  double focal_px) {
  const GyroAttitude attitude(gyro, Vector3d::Zero());
  std::vector<Vector3d> seen;
  double squares = 0.0;
  for (const FramePair& pair : problem.pairs()) {
    seen.push_back(image_rotation(pair, config, focal_px));
    squares += seen.back().squaredNorm();
  }
  if (!(std::sqrt(squares / static_cast<double>(seen.size())) > kLeastTurn_rad))
    throw std::invalid_argument("gyro readout: the camera hardly turns: shake it about all three axes, faster");
  State best;
  double least = std::numeric_limits<double>::infinity();
  for (double offset_s = -config.most_offset_s; offset_s <= config.most_offset_s; offset_s += kOffsetStep_s) {
    Matrix3d correlation = Matrix3d::Zero();
    std::vector<Vector3d> felt;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const FramePair& pair = problem.pairs()[k];
      const Eigen::AngleAxisd step(attitude(pair.from_s + offset_s).conjugate() * attitude(pair.to_s + offset_s));
      felt.push_back(step.angle() * step.axis());
      correlation += seen[k] * felt[k].transpose();
    }
    const Eigen::JacobiSVD<Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
    const Matrix3d axes = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    double sum = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k) sum += (seen[k] - axes * felt[k]).norm();
    if (sum >= least) continue;
    least = sum;
    best.axes = Quaterniond(axes);
    best.p[kOffset] = offset_s;
  }
  best.p[kFocal] = std::log(focal_px);
  return best;
}

void check(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro, const GyroReadoutConfig& config) {
  const auto fitted = std::count_if(pairs.begin(), pairs.end(), [](const FramePair& p) { return !p.held_out; });
  if (static_cast<std::size_t>(fitted) < kLeastPairs)
    throw std::invalid_argument("gyro readout: " + std::to_string(fitted) + " frame pairs to fit; give at least " +
                                std::to_string(kLeastPairs));
  double from_s = std::numeric_limits<double>::infinity(), to_s = -from_s;
  for (const FramePair& pair : pairs) {
    if (pair.points.size() < kLeastPoints) throw std::invalid_argument("gyro readout: a frame pair with few points");
    from_s = std::min(from_s, pair.from_s);
    to_s = std::max(to_s, pair.to_s);
  }
  const double beyond_s = config.most_offset_s + 0.1;
  if (gyro.size() < 16 || gyro.front().t_s > from_s - beyond_s || gyro.back().t_s < to_s + beyond_s)
    throw std::invalid_argument("gyro readout: the gyro record does not hold the frames and " +
                                std::to_string(beyond_s) + " s on either side: are both in the same unit and clock?");
  for (std::size_t i = 1; i < gyro.size(); ++i) {
    if (!(gyro[i].t_s > gyro[i - 1].t_s) || !gyro[i].rate_rad_s.allFinite())
      throw std::invalid_argument("gyro readout: gyro sample " + std::to_string(i) +
                                  ": time does not go on, or a rate is no number");
  }
}

double rms(const std::vector<double>& residuals) {
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return residuals.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(residuals.size()));
}

// Of every pair; returns that of the held-out ones together.
double pair_rms(const Problem& problem, const State& state, std::vector<double>& out) {
  std::vector<double> held_out;
  const std::vector<std::vector<double>> residuals = problem.residuals(state);
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    out.push_back(rms(residuals[k]));
    if (problem.pairs()[k].held_out) held_out.insert(held_out.end(), residuals[k].begin(), residuals[k].end());
  }
  return rms(held_out);
}

}  // namespace

GyroReadout fit_gyro_readout(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                             const GyroReadoutConfig& config) {
  check(pairs, gyro, config);
  const Problem problem(pairs, gyro, config);
  std::vector<Index> held;
  if (config.focal_px > 0.0) held.push_back(kFocal);
  std::vector<Index> held_without = held;
  held_without.push_back(kReadout);
  State without = first_guess(problem, gyro, config, config.focal_px > 0.0 ? config.focal_px : 0.9 * config.width_px);
  (void)minimise(problem, held_without, without);
  State with = without;
  const Matrix covariance = minimise(problem, held, with);

  GyroReadout out;
  const auto std_of = [&](Index i) { return std::sqrt(std::max(0.0, covariance(i, i))); };
  out.readout = {with.p[kReadout], std_of(kReadout)};
  out.offset_s = with.p[kOffset];
  out.offset_std_s = std_of(kOffset);
  out.focal_px = std::exp(with.p[kFocal]);
  out.focal_std_px = config.focal_px > 0.0 ? 0.0 : out.focal_px * std_of(kFocal);
  out.bias_rad_s = with.p.segment<3>(kBias);
  out.axes = with.axes.toRotationMatrix();
  out.rms_without_px = pair_rms(problem, without, out.pair_rms_without_px);
  out.rms_with_px = pair_rms(problem, with, out.pair_rms_with_px);
  return out;
}

}  // namespace core
