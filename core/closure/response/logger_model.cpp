#include "core/closure/response/logger_model.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/closure/noise_stream.h"
#include "core/closure/response/jackknife.h"
#include "core/closure/response/logger_phases.h"
#include "core/closure/structure_words.h"
#include "core/types/constants.h"

namespace core::closure {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kReachSamples = 6.0, kStepSamples = 0.1;  // range and step of the fine search about the coarse offset
constexpr const char* kOffset = "clock_offset";
constexpr const char* kRate = "clock_rate";
constexpr const char* kPolarity = "polarity";
constexpr double kMostRateError = 2e-3;

bool has(const std::vector<std::string>& effects, const char* name) {
  return std::find(effects.begin(), effects.end(), name) != effects.end();
}

// Phase modulo 180 degrees, in the range +-90.
double folded(double phase) { return 0.5 * std::remainder(2.0 * phase, kTwoPi); }

}  // namespace

LoggerModel::LoggerModel(const LoggerRecords& records)
    : rate_hz_(records.rate_hz), rigid_below_hz_(records.rigid_below_hz), name_(records.name) {
  LoggerPhases phases = logger_phases(records, kParts);
  coarse_s_ = std::move(phases.coarse_s);
  frequency_hz_ = std::move(phases.frequency_hz);
  part_time_s_ = std::move(phases.part_time_s);
  phase_ = std::move(phases.phase);
  weight_ = std::move(phases.weight);
}

LoggerModel::LoggerModel(const LoggerModel& other, std::vector<std::vector<VectorXd>> phase)
    : rate_hz_(other.rate_hz_),
      rigid_below_hz_(other.rigid_below_hz_),
      name_(other.name_),
      coarse_s_(other.coarse_s_),
      frequency_hz_(other.frequency_hz_),
      part_time_s_(other.part_time_s_),
      phase_(std::move(phase)),
      weight_(other.weight_) {}

std::vector<std::string> LoggerModel::effects() const {
  std::vector<std::string> out{kOffset, kRate};
  if (rigid_below_hz_ > 0.0) out.emplace_back(kPolarity);
  return out;
}

std::vector<NotObservable> LoggerModel::not_observable() const {
  std::vector<NotObservable> out{{"common_offset", "an offset common to all clocks leaves no residual",
                                  "an event that another clock stamps as well"}};
  if (rigid_below_hz_ <= 0.0)
    out.push_back({kPolarity, "a reversed logger shifts the phase by half a cycle, like motion in antiphase",
                   "give modes (--reference): well below the first mode all loggers move in phase"});
  return out;
}

// Offset for which the doubled phases, after its removal, agree best.
double LoggerModel::offset_of(std::size_t /*logger*/, const VectorXcd& sum, double around_s) const {
  const auto agreement = [&](double tau) {
    double value = 0.0;
    for (Index b = 0; b < sum.size(); ++b)
      value += (sum(b) * std::polar(1.0, -2.0 * kTwoPi * frequency_hz_(b) * tau)).real();
    return value;
  };
  const double step = kStepSamples / rate_hz_;
  const int reach = static_cast<int>(kReachSamples / kStepSamples);
  double best = -std::numeric_limits<double>::infinity(), at = around_s;
  for (int i = -reach; i <= reach; ++i) {
    const double value = agreement(around_s + i * step);
    if (value > best) best = value, at = around_s + i * step;
  }
  const double left = agreement(at - step), right = agreement(at + step), bend = left - 2.0 * best + right;
  return bend < 0.0 ? at + 0.5 * step * (left - right) / bend : at;
}

// True if this logger is opposite in sign to the first one in the band where all move as one.
bool LoggerModel::inverted(std::size_t logger, const Line& line, int without) const {
  double along = 0.0;
  for (std::size_t part = 0; part < part_time_s_.size(); ++part) {
    if (static_cast<int>(part) == without) continue;
    const double tau = line.offset_s + line.rate_error * part_time_s_[part];
    for (Index b = 0; b < frequency_hz_.size() && frequency_hz_(b) < rigid_below_hz_; ++b)
      along += weight_[logger][part](b) * std::cos(phase_[logger][part](b) - kTwoPi * frequency_hz_(b) * tau);
  }
  return along < 0.0;
}

LoggerModel::Line LoggerModel::find(std::size_t logger, const std::vector<std::string>& effects, int without) const {
  Line line;
  const bool offset = has(effects, kOffset), rate = has(effects, kRate);
  const bool polarity = has(effects, kPolarity);
  if (!offset && !rate) {
    line.inverted = polarity && inverted(logger, line, without);
    return line;
  }
  std::vector<double> times, offsets;
  VectorXcd all = VectorXcd::Zero(frequency_hz_.size());
  for (std::size_t part = 0; part < part_time_s_.size(); ++part) {
    if (static_cast<int>(part) == without) continue;
    VectorXcd own(frequency_hz_.size());
    for (Index b = 0; b < own.size(); ++b) own(b) = std::polar(weight_[logger][part](b), 2.0 * phase_[logger][part](b));
    all += own;
    if (rate) {
      times.push_back(part_time_s_[part]);
      offsets.push_back(offset_of(logger, own, offset ? coarse_s_[logger] : 0.0));
    }
  }
  if (offset) line.offset_s = offset_of(logger, all, coarse_s_[logger]);
  if (!rate) {
    line.inverted = polarity && inverted(logger, line, without);
    return line;
  }
  double tt = 0.0, ty = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    tt += times[i] * times[i];
    ty += times[i] * (offsets[i] - line.offset_s);
  }
  line.rate_error = tt > 0.0 ? ty / tt : 0.0;
  line.inverted = polarity && inverted(logger, line, without);
  return line;
}

VectorXd LoggerModel::residual(std::size_t logger, std::size_t part, const Line& line) const {
  const double tau = line.offset_s + line.rate_error * part_time_s_[part];
  VectorXd out(frequency_hz_.size());
  for (Index b = 0; b < out.size(); ++b) {
    const double left = phase_[logger][part](b) - kTwoPi * frequency_hz_(b) * tau;
    const bool rigid = frequency_hz_(b) < rigid_below_hz_;
    const double turned = left - (line.inverted ? std::numbers::pi : 0.0);
    out(b) = (rigid ? std::remainder(turned, kTwoPi) : folded(left)) * weight_[logger][part](b);
  }
  return out;
}

ResponseFit LoggerModel::fit(const std::vector<std::string>& effects) const {
  ResponseFit out;
  const std::size_t n_loggers = name_.size();
  out.fold_squares.assign(part_time_s_.size(), 0.0);
  double squares = 0.0, n = 0.0;
  std::vector<Line> whole(n_loggers);
  std::vector<std::vector<Line>> without(part_time_s_.size(), std::vector<Line>(n_loggers));
  for (std::size_t i = 1; i < n_loggers; ++i) {
    whole[i] = find(i, effects, -1);
    for (std::size_t part = 0; part < part_time_s_.size(); ++part) {
      without[part][i] = find(i, effects, static_cast<int>(part));
      squares += residual(i, part, whole[i]).squaredNorm();
      n += weight_[i][part].sum();
      out.fold_squares[part] += std::pow(kDegPerRad, 2) * residual(i, part, without[part][i]).squaredNorm();
    }
  }
  n = std::max(n, 1.0);
  out.residual_rms = kDegPerRad * std::sqrt(squares / n);
  out.heldout_rms = std::sqrt(out.heldout_squares() / n);
  out.noise_variance = std::max(out.residual_rms * out.residual_rms, 1e-12);
  out.noise_floor = 0.0;
  out.words = "phases between loggers are " + number(out.residual_rms) + " degrees rms off 0 and 180";
  out.left = "phases " + number(out.residual_rms) +
             " degrees rms off 0 and 180: leakage of short parts, damping that is not proportional, noise";
  for (const std::string& effect : effects) {
    const bool is_offset = effect == kOffset;
    const auto value = [&](const Line& line) {
      if (effect == kPolarity) return line.inverted ? 1.0 : 0.0;
      return is_offset ? 1e3 * line.offset_s : 1e6 * line.rate_error;
    };
    const auto values = [&](const std::vector<Line>& lines) {
      std::vector<ParameterValue> listed;
      const char* unit = is_offset ? "ms" : effect == kPolarity ? "1 = inverted" : "ppm";
      for (std::size_t i = 1; i < n_loggers; ++i) listed.push_back({name_[i], unit, value(lines[i]), {}});
      return listed;
    };
    std::vector<ParameterValue> own = values(whole);
    std::vector<std::vector<ParameterValue>> others;
    for (const auto& lines : without) others.push_back(values(lines));
    add_jackknife_sigmas(own, others);
    const bool wild = std::any_of(whole.begin(), whole.end(),
                                  [](const Line& line) { return std::abs(line.rate_error) > kMostRateError; });
    out.implausible.emplace_back(!is_offset && wild ? "no logger's clock is wrong by 0.2 %" : "");
    out.n_parameters += own.size();
    out.parameters.push_back(std::move(own));
  }
  return out;
}

// Permutes the residual phases of the model, which removes any pattern over frequency.
std::unique_ptr<ResponseModel> LoggerModel::surrogate(const std::vector<std::string>& effects,
                                                      std::uint64_t seed) const {
  NoiseStream noise(seed);
  auto phase = phase_;
  for (std::size_t i = 1; i < phase.size(); ++i) {
    const Line line = find(i, effects, -1);
    for (std::size_t part = 0; part < phase[i].size(); ++part) {
      const double tau = line.offset_s + line.rate_error * part_time_s_[part];
      const VectorXd left = phase[i][part] - kTwoPi * tau * frequency_hz_;
      std::vector<std::pair<double, Index>> order;
      for (Index b = 0; b < left.size(); ++b) order.emplace_back(noise.gaussian(), b);
      std::sort(order.begin(), order.end());
      for (Index b = 0; b < left.size(); ++b)
        phase[i][part](b) = kTwoPi * tau * frequency_hz_(b) + folded(left(order[static_cast<std::size_t>(b)].second)) +
                            (line.inverted && frequency_hz_(b) < rigid_below_hz_ ? std::numbers::pi : 0.0);
    }
  }
  return std::unique_ptr<ResponseModel>(new LoggerModel(*this, std::move(phase)));
}

std::vector<bool> LoggerModel::inverted(const std::vector<std::string>& effects) const {
  std::vector<bool> out(name_.size(), false);
  for (std::size_t i = 1; i < out.size(); ++i) out[i] = find(i, effects, -1).inverted;
  return out;
}

std::vector<double> LoggerModel::offsets_s(const std::vector<std::string>& effects) const {
  std::vector<double> out(name_.size(), 0.0);
  for (std::size_t i = 1; i < out.size(); ++i) out[i] = find(i, effects, -1).offset_s;
  return out;
}

}  // namespace core::closure
