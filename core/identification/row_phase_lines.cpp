// Lines of the camera by the phases of the rows.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/identification/camera_lines.h"
#include "core/identification/camera_shape.h"
#include "core/identification/line_height.h"
#include "core/linear/median.h"
#include "core/types/constants.h"
#include "core/types/witness.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kOneDirection = 0.99;     // |cosine| between axes that measure the same
constexpr std::size_t kFewestSensors = 5;  // two for the structure, two for the slow camera, one for the line
constexpr std::size_t kMostSensors = 10;   // more cost time only
constexpr double kValuesPerSensor = 2.0;   // independent values of a bin, for its inverse
constexpr int kStep = 2;                   // bins from one value to the next: each is a mean over four times as many
constexpr double kLoading = 1e-6;          // of the mean power, added to the diagonal
// An alias order whose phases over the rows are like those of a frequency within the search range shows the structure.
constexpr double kLikeStructure = 0.6;
constexpr std::size_t kFewestOrders = 5;
// Height of an order over the median height of all: a strong mode raises every order alike.
constexpr double kLeastContrast = 10.0, kSurelyContrast = 50.0;
// What a strong mode leaves in the orders lies this near to it, or in more orders than those of a line.
constexpr double kNearMode_hz = 0.5;
constexpr double kNotDistinguished = 0.5, kLineEdge = 1.0 / 8.0;
constexpr int kCentrings = 3;

// Channels that measure one direction, seen in rows of their own.
struct Sensors {
  std::vector<int> channel;
  std::vector<double> sign, delay_s;
};

Sensors sensors_of(const std::vector<ChannelInfo>& channels) {
  std::vector<std::size_t> alike;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].n_integrations == 0 && !witnesses_turn(channels[c]) &&
        std::abs(cosine_between(channels[c], channels.front())) > kOneDirection)
      alike.push_back(c);
  }
  std::stable_sort(alike.begin(), alike.end(),
                   [&](std::size_t a, std::size_t b) { return channels[a].row_delay_s < channels[b].row_delay_s; });
  const std::size_t n = std::min(alike.size(), kMostSensors);
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < n; ++i) used.push_back(alike[n > 1 ? i * (alike.size() - 1) / (n - 1) : 0]);
  std::sort(used.begin(), used.end());
  Sensors out;
  for (const std::size_t c : used) {
    out.channel.push_back(static_cast<int>(c));
    out.sign.push_back(cosine_between(channels[c], channels.front()) < 0.0 ? -1.0 : 1.0);
    out.delay_s.push_back(channels[c].row_delay_s);
  }
  return out;
}

class RowArray {
 public:
  RowArray(const CpsdSums& sums, Sensors sensors, const FoldingConfig& folding)
      : sums_(sums),
        sensors_(std::move(sensors)),
        rate_hz_(sums.rate_hz),
        hz_per_step_(kStep * sums.rate_hz / sums.n_fft),
        limit_hz_(std::max(folding.max_frequency_hz, 0.5 * sums.rate_hz)),
        reach_(static_cast<int>(std::ceil(std::max(kFastestCamera_hz, limit_hz_) / sums.rate_hz)) + 1),
        n_steps_((sums.n_bins() + kStep - 1) / kStep) {
    if (sensors_.channel.size() < kFewestSensors ||
        values_per_bin(sums) < kValuesPerSensor * static_cast<double>(sensors_.channel.size()))
      return;
    for (int n = 0; n <= 2 * reach_; ++n) likeness_.push_back(phase_likeness(n * rate_hz_, sensors_.delay_s));
    set_beyond();
    const auto has_enough = [](const std::vector<std::size_t>& orders) { return orders.size() >= kFewestOrders; };
    if (std::any_of(beyond_.begin(), beyond_.end(), has_enough)) set_contrast();
  }

  // The clearest first. motion stays empty.
  [[nodiscard]] std::vector<CameraLine> lines(const std::vector<double>& modes_hz) const {
    std::vector<CameraLine> out;
    std::vector<std::vector<double>> contrast = contrast_;
    while (!contrast.empty() && out.size() < kMostCameraLines) {
      std::size_t order = 0, step = 0;
      for (std::size_t k = 0; k < contrast.size(); ++k) {
        const auto highest = std::max_element(contrast[k].begin(), contrast[k].end());
        if (*highest > contrast[order][step]) order = k, step = static_cast<std::size_t>(highest - contrast[k].begin());
      }
      if (contrast[order][step] < kLeastContrast) break;
      const double highest_hz = static_cast<double>(step) * hz_per_step_;
      CameraLine line = line_at(order, step);
      const bool is_near_mode = std::any_of(modes_hz.begin(), modes_hz.end(), [&](double hz) {
        return std::min(std::abs(line.apparent_hz - hz), std::abs(highest_hz - hz)) < kNearMode_hz;
      });
      const bool is_distinct =
          line.true_hz.size() <= kMostTrueFrequencies && (!is_near_mode || line.height > kSurelyContrast);
      leave_out(highest_hz, is_distinct ? 2.0 * kLineReach_hz : kNearMode_hz, contrast);
      if (is_distinct) out.push_back(std::move(line));
    }
    return out;
  }

 private:
  void leave_out(double hz, double reach_hz, std::vector<std::vector<double>>& contrast) const {
    const int first = std::max(0, static_cast<int>((hz - reach_hz) / hz_per_step_));
    const int last = std::min(n_steps_ - 1, static_cast<int>((hz + reach_hz) / hz_per_step_));
    for (auto& of_order : contrast) std::fill(of_order.begin() + first, of_order.begin() + last + 1, 0.0);
  }

  [[nodiscard]] std::size_t n_orders() const noexcept { return 2 * static_cast<std::size_t>(reach_) + 1; }

  [[nodiscard]] double signed_hz(std::size_t order, double apparent_hz) const noexcept {
    return apparent_hz + (static_cast<int>(order) - reach_) * rate_hz_;
  }

  // Neither within the search range, nor alike a frequency that is.
  [[nodiscard]] bool is_beyond(std::size_t order, double apparent_hz) const {
    const double hz = std::abs(signed_hz(order, apparent_hz));
    if (hz <= limit_hz_ || hz > kFastestCamera_hz) return false;
    for (std::size_t other = 0; other < n_orders(); ++other) {
      const double alike = likeness_[order > other ? order - other : other - order];
      if (alike > kLikeStructure && std::abs(signed_hz(other, apparent_hz)) <= limit_hz_) return false;
    }
    return true;
  }

  void set_beyond() {
    beyond_.resize(static_cast<std::size_t>(n_steps_));
    for (int step = 0; step < n_steps_; ++step) {
      for (std::size_t order = 0; order < n_orders(); ++order) {
        if (is_beyond(order, step * hz_per_step_)) beyond_[static_cast<std::size_t>(step)].push_back(order);
      }
    }
  }

  [[nodiscard]] Eigen::MatrixXcd smoothed_cross_spectrum(int step) const {
    const auto n = static_cast<Eigen::Index>(sensors_.channel.size());
    Eigen::MatrixXcd out = Eigen::MatrixXcd::Zero(n, n);
    const auto [first, last] = smoothing_at(kStep * step, sums_.n_bins());
    for (int b = first; b <= last; ++b) {
      const Complex* pairs = sums_.data_sum.data() + static_cast<std::ptrdiff_t>(b) * sums_.n_pairs();
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = i; j < n; ++j) {
          const auto a = static_cast<std::size_t>(i), z = static_cast<std::size_t>(j);
          out(i, j) += sensors_.sign[a] * sensors_.sign[z] *
                       pairs[CpsdSums::pair_index(sensors_.channel[a], sensors_.channel[z], sums_.n_channels)];
        }
      }
    }
    out /= static_cast<double>(last - first + 1);
    out.triangularView<Eigen::StrictlyLower>() = out.adjoint();
    return out;
  }

  // Phases of a frequency in the sensors.
  [[nodiscard]] Eigen::VectorXcd phases_of(double hz) const {
    Eigen::VectorXcd out(static_cast<Eigen::Index>(sensors_.delay_s.size()));
    for (Eigen::Index i = 0; i < out.size(); ++i)
      out[i] = std::polar(1.0, kTwoPi * hz * sensors_.delay_s[static_cast<std::size_t>(i)]);
    return out;
  }

  // 1 / u' S^-1 u of every order, u the phases of its frequency; 0 without motion.
  [[nodiscard]] Eigen::VectorXd least_variances(int step) const {
    const auto n = static_cast<Eigen::Index>(n_orders());
    Eigen::MatrixXcd spectrum = smoothed_cross_spectrum(step);
    const double mean = spectrum.trace().real() / static_cast<double>(spectrum.rows());
    spectrum.diagonal().array() += kLoading * mean;
    const Eigen::LLT<Eigen::MatrixXcd> factor(spectrum);
    if (!(mean > 0.0) || factor.info() != Eigen::Success) return Eigen::VectorXd::Zero(n);
    Eigen::MatrixXcd phases(spectrum.rows(), n);
    const Eigen::VectorXcd of_one_order = phases_of(rate_hz_);
    phases.col(0) = phases_of(signed_hz(0, step * hz_per_step_));
    for (Eigen::Index k = 1; k < n; ++k) phases.col(k) = phases.col(k - 1).cwiseProduct(of_one_order);
    factor.matrixL().solveInPlace(phases);
    return phases.colwise().squaredNorm().cwiseInverse().transpose();
  }

  void set_contrast() {
    Eigen::MatrixXd power(n_steps_, static_cast<Eigen::Index>(n_orders()));
    for (int step = 0; step < n_steps_; ++step) power.row(step) = least_variances(step).transpose();
    std::vector<std::vector<double>> height;
    for (Eigen::Index order = 0; order < power.cols(); ++order)
      height.push_back(heights({power.col(order).begin(), power.col(order).end()}, hz_per_step_));
    contrast_.assign(n_orders(), std::vector<double>(static_cast<std::size_t>(n_steps_), 0.0));
    std::vector<double> allowed;
    for (std::size_t step = 0; step < beyond_.size(); ++step) {
      if (beyond_[step].size() < kFewestOrders) continue;
      allowed.clear();
      for (const std::size_t order : beyond_[step]) allowed.push_back(height[order][step]);
      const double usual = std::max(1.0, median_in_place(allowed));
      for (const std::size_t order : beyond_[step]) contrast_[order][step] = height[order][step] / usual;
    }
  }

  // A strong line is suppressed in its own middle: its centre is that of its flanks.
  [[nodiscard]] double centre_hz(std::size_t order, std::size_t highest) const {
    const std::vector<double>& height = contrast_[order];
    const double least = kLineEdge * height[highest], reach = kLineReach_hz / hz_per_step_;
    auto at = static_cast<double>(highest);
    for (int round = 0; round < kCentrings; ++round) {
      double sum = 0.0, moment = 0.0;
      const auto first = static_cast<std::size_t>(std::max(0.0, at - reach));
      for (std::size_t step = first; step < height.size() && static_cast<double>(step) <= at + reach; ++step) {
        if (height[step] > least) sum += height[step], moment += height[step] * static_cast<double>(step);
      }
      if (sum > 0.0) at = moment / sum;
    }
    return at * hz_per_step_;
  }

  [[nodiscard]] CameraLine line_at(std::size_t order, std::size_t step) const {
    CameraLine out;
    out.apparent_hz = centre_hz(order, step);
    out.half_width_hz = kLineReach_hz;
    out.height = contrast_[order][step];
    double second = 0.0;
    for (std::size_t other = 0; other < contrast_.size(); ++other) {
      const double share = contrast_[other][step] / out.height;
      if (share >= kNotDistinguished) out.true_hz.push_back(signed_hz(other, out.apparent_hz));
      if (other != order) second = std::max(second, share);
    }
    out.margin = 1.0 - second;
    std::sort(out.true_hz.begin(), out.true_hz.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
    return out;
  }

  const CpsdSums& sums_;
  Sensors sensors_;
  double rate_hz_, hz_per_step_, limit_hz_;
  int reach_, n_steps_;                           // alias orders -reach_ ... reach_; values along the frequency
  std::vector<double> likeness_;                  // by the distance of two orders
  std::vector<std::vector<std::size_t>> beyond_;  // per step: the orders that the structure does not show
  std::vector<std::vector<double>> contrast_;     // orders x steps; 0 where an order may show the structure
};

}  // namespace

std::vector<CameraLine> lines_by_row_phases(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                            const FoldingConfig& folding, const std::vector<double>& modes_hz) {
  if (channels.empty()) return {};
  std::vector<CameraLine> lines = RowArray(sums, sensors_of(channels), folding).lines(modes_hz);
  for (CameraLine& line : lines) {
    for (std::size_t c = 0; c < folding.delay_s.size(); ++c) {
      const double turn = kTwoPi * line.true_hz.front() * folding.delay_s[c];
      line.motion.push_back(cosine_between(channels[c], channels.front()) * std::polar(1.0, turn));
    }
  }
  return lines;
}

}  // namespace core
