#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/closure/response/response_model.h"

namespace core::closure {

// Records of loggers on one structure, each with its own clock: nominally equal rates and a common start.
struct LoggerRecords {
  double rate_hz = 0.0;
  std::vector<std::string> name;
  std::vector<std::vector<double>> value;        // per logger; lengths may differ; NaN is replaced by 0 (the mean)
  double band_low_hz = 0.5, band_high_hz = 0.0;  // 0 = 0.2 of the rate
  double rigid_below_hz = 0.0;                   // well below the first mode, where all move as one; 0 = unknown
};

// Proportionally damped structures respond in phase or in antiphase: the doubled phase of a cross-spectrum between two
// loggers is 0 at every frequency, whatever the modes. A clock offset tau adds a phase of 2 pi f tau. Residual: that
// phase, wrapped to +-90 degrees, over all bins of the parts in which both loggers move, of the first logger with each
// other one. Held out: one part in time. Unit: degrees (52 = uniform phase).
class LoggerModel final : public ResponseModel {
 public:
  static constexpr double kMaterial = 0.1;
  static constexpr std::size_t kParts = 5;

  // Throws std::invalid_argument: fewer than two loggers, no rate, records shorter than 5 s or 256 samples.
  explicit LoggerModel(const LoggerRecords& records);

  [[nodiscard]] std::string unit() const override { return "deg"; }
  [[nodiscard]] std::vector<std::string> effects() const override;
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] double material_share(const std::string& /*effect*/) const override { return kMaterial; }
  [[nodiscard]] ResponseFit fit(const std::vector<std::string>& effects) const override;
  [[nodiscard]] std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>& effects,
                                                         std::uint64_t seed) const override;

  // True per logger that is mounted in the direction opposite to the first one.
  [[nodiscard]] std::vector<bool> inverted(const std::vector<std::string>& effects) const;

  // Delay of each logger's samples relative to those of the first one with the same number; 0 without the effect.
  [[nodiscard]] std::vector<double> offsets_s(const std::vector<std::string>& effects) const;

 private:
  LoggerModel(const LoggerModel& other, std::vector<std::vector<Eigen::VectorXd>> phase);

  // One logger against the first, without these parts.
  struct Line {
    double offset_s = 0.0, rate_error = 0.0;
    bool inverted = false;
  };
  [[nodiscard]] Line find(std::size_t logger, const std::vector<std::string>& effects, int without) const;
  [[nodiscard]] double offset_of(std::size_t logger, const Eigen::VectorXcd& sum, double around_s) const;
  [[nodiscard]] Eigen::VectorXd residual(std::size_t logger, std::size_t part, const Line& line) const;  // rad, wrapped

  [[nodiscard]] bool inverted(std::size_t logger, const Line& line, int without) const;

  double rate_hz_ = 0.0, rigid_below_hz_ = 0.0;
  std::vector<std::string> name_;
  std::vector<double> coarse_s_;                              // per logger
  Eigen::VectorXd frequency_hz_;                              // of the bins
  std::vector<double> part_time_s_;                           // centre of each part, from the record's centre
  std::vector<std::vector<Eigen::VectorXd>> phase_, weight_;  // logger, part: per bin, rad (by sample number)
};

}  // namespace core::closure
