#include "core/rotors/motor_lines.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/identification/readout_from_shapes.h"
#include "core/linear/median.h"
#include "core/types/constants.h"
#include "core/types/displacement.h"

namespace core {
namespace {

constexpr int kMultiples = 3;
constexpr double kTachometer = 1e-3;  // relative error of a stated rate
constexpr double kLeastCameraShare = 0.9;
constexpr std::size_t kLeastChannels = 5;  // two unknowns, and redundancy
constexpr double kMostAlike = 0.8;         // of the delays' phases at two frequencies (line_evidence.cpp)
constexpr const char* kRotorLine = "rotor_line";

double apparent(double hz, double rate_hz) { return std::abs(std::remainder(hz, rate_hz)); }

template <class... Args>
std::string text(const char* format, Args... args) {
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, args...);
  return buffer.data();
}

const closure::ParameterValue* parameter(const closure::ClosureStep& step, const char* name) {
  const auto at =
      std::find_if(step.parameters.begin(), step.parameters.end(), [&](const auto& p) { return p.name == name; });
  return at == step.parameters.end() ? nullptr : &*at;
}

// Frequency of the line with the sign that appears at this frequency of the samples.
double signed_hz(const MotorLine& line, double apparent_hz, double rate_hz) {
  const double hz = line.multiple * line.motor.hz;
  const auto away = [&](double f) { return std::abs(std::remainder(f - apparent_hz, rate_hz)); };
  return away(hz) <= away(-hz) ? hz : -hz;
}

// Share of the observed shape's square that a constant and a slope over the delays explain, once the delays are undone
// at the line's frequency in place of the mode's. Empty: the delays do not distinguish the two frequencies.
std::optional<double> camera_share(const Mode& mode, const MotorLine& line, double rate_hz,
                                   const std::vector<double>& delay_s) {
  const std::size_t n = mode.shape.size();
  if (n < kLeastChannels || delay_s.size() < n) return std::nullopt;
  std::vector<ChannelInfo> channels(n);
  for (std::size_t c = 0; c < n; ++c) channels[c].row_delay_s = delay_s[c];
  const std::vector<std::complex<double>> observed = observed_pole(mode, channels, rate_hz).shape;
  const Eigen::Map<const Eigen::VectorXd> delay(delay_s.data(), static_cast<Eigen::Index>(n));
  const auto turned_by = [&](double hz) -> Eigen::VectorXcd {
    return (std::complex<double>(0.0, -kTwoPi * hz) * delay.cast<std::complex<double>>()).array().exp();
  };
  const double hz = signed_hz(line, mode.apparent_hz, rate_hz);
  if (std::abs(turned_by(hz - mode.apparent_hz - mode.fold_n.value_or(0) * rate_hz).mean()) > kMostAlike)
    return std::nullopt;
  const Eigen::VectorXcd shape =
      turned_by(hz).cwiseProduct(Eigen::Map<const Eigen::VectorXcd>(observed.data(), static_cast<Eigen::Index>(n)));
  const Eigen::VectorXd slope = delay.array() - delay.mean();
  const double whole = shape.squaredNorm(), slopes = slope.squaredNorm();
  if (!(whole > 0.0 && slopes > 0.0)) return std::nullopt;
  const std::complex<double> along = shape.cwiseProduct(slope.cast<std::complex<double>>()).sum();
  return (static_cast<double>(n) * std::norm(shape.mean()) + std::norm(along) / slopes) / whole;
}

// Poles of the stabilisation diagram refer to places in both lists.
void reject_camera_motion(ModalEstimate& estimate) {
  const std::size_t n = estimate.modes.size();
  std::vector<int> order(n), place(n);
  std::iota(order.begin(), order.end(), 0);
  const auto first = std::stable_partition(order.begin(), order.end(), [&](int i) {
    return estimate.modes[static_cast<std::size_t>(i)].verdict == Verdict::kStructural;
  });
  for (std::size_t i = 0; i < n; ++i) place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  for (StabilisationPole& pole : estimate.poles) {
    if (pole.i_line >= 0 && static_cast<std::size_t>(pole.i_line) < n)
      pole.i_line = place[static_cast<std::size_t>(pole.i_line)];
  }
  const auto take = [&](auto from, auto to) {
    std::vector<Mode> out;
    for (; from != to; ++from) out.push_back(std::move(estimate.modes[static_cast<std::size_t>(*from)]));
    return out;
  };
  std::vector<Mode> modes = take(order.begin(), first), moved = take(first, order.end());
  estimate.modes = std::move(modes);
  estimate.rejected.insert(estimate.rejected.begin(), std::make_move_iterator(moved.begin()),
                           std::make_move_iterator(moved.end()));
}

}  // namespace

std::string words_of(const MotorLine& line) {
  static constexpr std::array kTimes{"the rate", "twice the rate", "three times the rate"};
  return text("%s of motor %d, %.2f +- %.2f Hz, appears at %.2f Hz",
              kTimes[static_cast<std::size_t>(line.multiple - 1)], line.motor.number, line.motor.hz,
              line.motor.spread_hz, line.apparent_hz);
}

std::vector<MotorLine> MotorLines::lines(double rate_hz, double resolution_hz) const {
  std::vector<MotorLine> out;
  for (const MotorRate& motor : motors_) {
    for (int multiple = 1; multiple <= kMultiples; ++multiple) {
      const double of_motor = std::hypot(2.0 * motor.spread_hz, kTachometer * motor.hz);
      out.push_back({motor, multiple, apparent(multiple * motor.hz, rate_hz), multiple * of_motor + resolution_hz});
    }
  }
  return out;
}

MotorRate motor_rate(int number, std::vector<double> hz) {
  const double middle = median(hz);
  for (double& value : hz) value = std::abs(value - middle);
  return {number, middle, kSigmaPerMad * median_in_place(hz)};
}

std::optional<MotorLine> MotorLines::at(double apparent_hz, double rate_hz, double resolution_hz) const {
  std::optional<MotorLine> nearest;
  for (const MotorLine& line : lines(rate_hz, resolution_hz)) {
    const double away = std::abs(line.apparent_hz - apparent_hz);
    if (away <= line.width_hz && (!nearest || away < std::abs(nearest->apparent_hz - apparent_hz))) nearest = line;
  }
  return nearest;
}

void MotorLines::judge(ModalEstimate& estimate, const std::vector<double>& delay_s) const {
  if (empty() || !(estimate.rate_hz > 0.0)) return;
  const auto line_of = [&](const Mode& pole) { return at(pole.apparent_hz, estimate.rate_hz, estimate.resolution_hz); };
  for (Mode& pole : estimate.rejected) {
    if (pole.verdict == Verdict::kNumerical || pole.verdict == Verdict::kCandidate) continue;
    if (const auto line = line_of(pole)) pole.reason += "; " + words_of(*line);
  }
  for (Mode& mode : estimate.modes) {
    const auto line = line_of(mode);
    if (!line || mode.damping_ratio * mode.frequency_hz > line->width_hz) continue;
    const std::optional<double> share = camera_share(mode, *line, estimate.rate_hz, delay_s);
    if (!share) {
      mode.reason += "; a vibration of the camera would appear here, too: " + words_of(*line);
    } else if (*share >= kLeastCameraShare) {
      mode.verdict = Verdict::kCameraMotion;
      mode.reason = "a vibration of the camera at the rate of a motor: " + words_of(*line);
    }
  }
  reject_camera_motion(estimate);
}

void MotorLines::name(closure::ClosureResult& result, double rate_hz, double duration_s) const {
  for (closure::ClosureStep& step : result.steps) {
    const closure::ParameterValue* const hz = parameter(step, "apparent frequency");
    if (step.id.key != kRotorLine || hz == nullptr || !(duration_s > 0.0)) continue;
    const auto line = at(hz->value, rate_hz, 1.0 / duration_s);
    const std::string words = line ? words_of(*line) : "no motor's rate, doubled or tripled, appears there";
    step.meaning += (step.meaning.empty() ? "" : "; ") + words;
  }
}

}  // namespace core
