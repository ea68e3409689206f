#include "core/closure/response/clock_model.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/closure/noise_stream.h"
#include "core/closure/response/effects/catalogue.h"
#include "core/closure/response/jackknife.h"
#include "core/closure/structure_words.h"
#include "core/linear/median.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kClockParts = 30;
constexpr Index kNeighbours = 5;  // on either side, for the median
constexpr double kMostMisread = 0.25;
constexpr double kColoured = 0.25;  // correlation of successive residuals that exceeds chance

// Median slope between readings half the record apart, which is robust against misread ones.
double robust_slope(const VectorXd& x, const VectorXd& y) {
  std::vector<double> slopes;
  const Index half = x.size() / 2;
  for (Index i = 0; i + half < x.size(); ++i) slopes.push_back((y(i + half) - y(i)) / (x(i + half) - x(i)));
  return median(std::move(slopes));
}

// Deviation of each residual from the median of its neighbours.
VectorXd from_neighbours(const VectorXd& residual) {
  VectorXd out(residual.size());
  for (Index i = 0; i < residual.size(); ++i) {
    std::vector<double> near;
    for (Index j = std::max<Index>(i - kNeighbours, 0); j <= std::min(i + kNeighbours, residual.size() - 1); ++j)
      near.push_back(residual(j));
    out(i) = residual(i) - median(std::move(near));
  }
  return out;
}

double robust_deviation(const VectorXd& values) {
  std::vector<double> sizes;
  for (const double v : values) sizes.push_back(std::abs(v));
  return kSigmaPerMad * median(std::move(sizes));
}

VectorXd picked(const VectorXd& values, const std::vector<Index>& rows) { return values(rows); }

[[noreturn]] void refuse_clock(const std::string& what) { throw std::invalid_argument("clock: " + what); }

}  // namespace

struct ClockModel::Solution {
  VectorXd offset_and_coefficients, predicted_s;
  std::vector<VectorXd> places;  // per effect
  [[nodiscard]] VectorXd of(Index first, Index n) const { return offset_and_coefficients.segment(first, n); }
};

ClockModel::ClockModel(ClockReadings readings, DeclaredTime declared) : declared_(declared) {
  if (!(declared_.rate_hz > 0.0)) refuse_clock("the declared frame rate must be positive");
  if (readings.frame.size() != readings.reading_s.size()) refuse_clock("as many frames as readings");
  std::vector<double> frames, values;
  for (std::size_t i = 0; i < readings.frame.size(); ++i) {
    if (!std::isfinite(readings.reading_s[i])) continue;
    if (!std::isfinite(readings.frame[i]) || (!frames.empty() && !(readings.frame[i] > frames.back())))
      refuse_clock("frame numbers must ascend; reading " + std::to_string(i + 1) + " does not");
    frames.push_back(readings.frame[i]);
    values.push_back(readings.reading_s[i]);
  }
  if (frames.size() < kFewest)
    refuse_clock(std::to_string(frames.size()) + " readings are too few for held-out data; give " +
                 std::to_string(kFewest) + " or more");
  frame_ = Eigen::Map<const VectorXd>(frames.data(), static_cast<Index>(frames.size()));
  reading_s_ = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  const double slope = robust_slope(frame_, reading_s_);
  if (!(slope > 0.0))
    refuse_clock(
        "the readings go " + number(slope) +
        " s per frame: the clock stands still or runs backward; is it a countdown, or are the columns swapped?");
  const VectorXd off = from_neighbours(reading_s_ - slope * frame_);
  const double deviation = std::max({robust_deviation(off), readings.sigma_s, 1e-6});
  std::vector<Index> good;
  for (Index i = 0; i < off.size(); ++i) {
    if (std::abs(off(i)) <= kMisread * deviation) good.push_back(i);
  }
  n_misread_ = frames.size() - good.size();
  if (static_cast<double>(n_misread_) > kMostMisread * static_cast<double>(frames.size()))
    refuse_clock(std::to_string(n_misread_) + " of " + std::to_string(frames.size()) +
                 " readings deviate from their neighbours: not a steady clock; read it again");
  frame_ = picked(frame_, good);
  reading_s_ = picked(reading_s_, good);
  sigma_s_ = readings.sigma_s > 0.0 ? readings.sigma_s : std::max(robust_deviation(picked(off, good)), 1e-6);
}

ClockModel::ClockModel(const ClockModel& other, VectorXd reading_s)
    : declared_(other.declared_), frame_(other.frame_), reading_s_(std::move(reading_s)), sigma_s_(other.sigma_s_) {}

std::vector<std::string> ClockModel::effects() const {
  std::vector<std::string> out;
  for (const auto& effect : clock_effects()) out.push_back(effect->name());
  return out;
}

std::vector<NotObservable> ClockModel::not_observable() const {
  return {{"clock_offset", "the zero of a filmed clock is arbitrary: the offset is part of the model",
           "film an event that another record shows as well"},
          {"time_stamp_jitter", "jitter smaller than the scatter of the readings is hidden by them",
           "a clock that is read more finely, or time stamps of the camera"}};
}

// Fit without the readings of [from, to).
ClockModel::Solution ClockModel::solve(const std::vector<std::string>& effects, Index from, Index to) const {
  std::vector<char> seen(static_cast<std::size_t>(frame_.size()), 1);
  for (Index i = from; i < to; ++i) seen[static_cast<std::size_t>(i)] = 0;
  std::vector<Index> rows;
  for (Index i = 0; i < frame_.size(); ++i) {
    if (seen[static_cast<std::size_t>(i)] != 0) rows.push_back(i);
  }
  const double last = frame_(frame_.size() - 1);
  const VectorXd target = reading_s_ - frame_ / declared_.rate_hz;
  MatrixXd columns = MatrixXd::Ones(frame_.size(), 1);
  Solution out;
  const auto solve_columns = [&] {
    out.offset_and_coefficients = MatrixXd(columns(rows, Eigen::all)).colPivHouseholderQr().solve(picked(target, rows));
    out.predicted_s = columns * out.offset_and_coefficients;
  };
  solve_columns();
  for (const std::string& name : effects) {
    const ClockEffect& effect = clock_effect(name);
    out.places.push_back(effect.place(frame_, target - out.predicted_s, seen));
    const MatrixXd added = effect.columns(frame_, last, out.places.back());
    columns.conservativeResize(Eigen::NoChange, columns.cols() + added.cols());
    columns.rightCols(added.cols()) = added;
    solve_columns();
  }
  out.predicted_s += frame_ / declared_.rate_hz;
  return out;
}

ResponseFit ClockModel::fit(const std::vector<std::string>& effects) const {
  const Index n = frame_.size();
  const double last = frame_(n - 1);
  const Solution whole = solve(effects, 0, 0);
  ResponseFit out;
  std::vector<Solution> without;
  double squares = 0.0;
  for (Index part = 0; part < kClockParts; ++part) {
    const Index from = part * n / kClockParts, to = (part + 1) * n / kClockParts;
    without.push_back(solve(effects, from, to));
    out.fold_squares.push_back(1e6 * (reading_s_ - without.back().predicted_s).segment(from, to - from).squaredNorm());
    squares += out.fold_squares.back();
  }
  Index first = 1;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const ClockEffect& effect = clock_effect(effects[e]);
    const Index m = effect.columns(frame_.head(1), last, whole.places[e]).cols();
    std::vector<ParameterValue> values =
        effect.parameters(whole.of(first, m), whole.places[e], declared_.rate_hz, last);
    std::vector<std::vector<ParameterValue>> others;
    for (const Solution& one : without)
      others.push_back(effect.parameters(one.of(first, m), one.places[e], declared_.rate_hz, last));
    add_jackknife_sigmas(values, others);
    out.n_parameters += values.size();
    out.parameters.push_back(std::move(values));
    out.implausible.push_back(effect.implausible(whole.of(first, m), declared_.rate_hz));
    first += m;
  }
  const VectorXd residual = reading_s_ - whole.predicted_s;
  out.residual_rms = 1e3 * std::sqrt(residual.squaredNorm() / static_cast<double>(n));
  out.heldout_rms = std::sqrt(squares / static_cast<double>(n));
  out.noise_floor = 1e3 * sigma_s_;
  out.noise_variance = 1e6 * sigma_s_ * sigma_s_;
  const double lag_one = residual.head(n - 1).dot(residual.tail(n - 1)) / std::max(residual.squaredNorm(), 1e-300);
  out.structured = lag_one > kColoured + 3.0 / std::sqrt(static_cast<double>(n));
  out.words = "correlation of successive residuals is " + number(lag_one);
  out.left = describe(residual);
  return out;
}

// Describes the part of the record whose readings deviate most to one side.
std::string ClockModel::describe(const VectorXd& residual_s) const {
  constexpr Index kStretch = 20;
  double worst = 0.0;
  Index at = 0;
  for (Index i = 0; i + kStretch <= residual_s.size(); ++i) {
    const double mean = residual_s.segment(i, kStretch).mean();
    if (std::abs(mean) > std::abs(worst)) worst = mean, at = i;
  }
  return "readings deviate together for a while, at most by " + number(1e3 * worst) + " ms (mean of 20, frames " +
         number(frame_(at)) + " to " + number(frame_(std::min(at + kStretch, residual_s.size()) - 1)) +
         "): the clock's display, or the camera; a moving structure filmed beside it would "
         "distinguish them";
}

std::unique_ptr<ResponseModel> ClockModel::surrogate(const std::vector<std::string>& effects,
                                                     std::uint64_t seed) const {
  const Solution whole = solve(effects, 0, 0);
  const VectorXd residual = reading_s_ - whole.predicted_s;
  const Index n = residual.size();
  // First-order autoregressive noise with the variance and correlation of the residual. The variance is that of the
  // readings about their neighbours, which does not contain the effect under test.
  const VectorXd local = from_neighbours(residual);
  const double scatter = std::max(sigma_s_, robust_deviation(local));
  const double lag_one = local.head(n - 1).dot(local.tail(n - 1)) / std::max(local.squaredNorm(), 1e-300);
  const double memory = std::clamp(lag_one, 0.0, 0.9);
  NoiseStream noise(seed);
  VectorXd made = whole.predicted_s;
  double state = noise.gaussian();
  for (Index i = 0; i < n; ++i) {
    made(i) += scatter * state;
    state = memory * state + std::sqrt(1.0 - memory * memory) * noise.gaussian();
  }
  return std::unique_ptr<ResponseModel>(new ClockModel(*this, std::move(made)));
}

std::vector<double> ClockModel::frame_times_s(const std::vector<std::string>& effects, std::size_t n_frames) const {
  const Solution whole = solve(effects, 0, 0);
  VectorXd frame(static_cast<Index>(n_frames));
  for (Index k = 0; k < frame.size(); ++k) frame(k) = static_cast<double>(k);
  VectorXd time = frame / declared_.rate_hz;
  Index first = 1;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const MatrixXd columns = clock_effect(effects[e]).columns(frame, frame_(frame_.size() - 1), whole.places[e]);
    time += columns * whole.of(first, columns.cols());
    first += columns.cols();
  }
  time.array() -= time.size() > 0 ? time(0) : 0.0;
  return {time.data(), time.data() + time.size()};
}

}  // namespace core::closure
