#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/response/response_model.h"

namespace core::closure {

// A filmed clock, read in some of the frames.
struct ClockReadings {
  std::vector<double> frame;      // ascending frame numbers
  std::vector<double> reading_s;  // NaN = not readable in that frame
  double sigma_s = 0.0;           // standard deviation of a reading; 0 = unknown, estimated from its steps
};

// Declared time of the frames: frame number / rate.
struct DeclaredTime {
  double rate_hz = 0.0;
};

// A reading is offset + frame / rate + the effects; the offset is always fitted, because the zero of the clock is
// arbitrary. Held out: ten contiguous parts, each predicted from the other nine. Misread values (more than
// kMisread robust standard deviations from the median of their neighbours, at any rate) are excluded and counted.
// Unit: ms.
class ClockModel final : public ResponseModel {
 public:
  static constexpr double kMisread = 5.0;
  static constexpr std::size_t kFewest = 40;  // readings
  static constexpr double kMaterial = 0.05;   // of the held-out squares

  // Throws std::invalid_argument: no rate, frame numbers that do not ascend, too few readings, a clock that stops or
  // runs backward, more than a quarter of the readings misread.
  ClockModel(ClockReadings readings, DeclaredTime declared);

  [[nodiscard]] std::string unit() const override { return "ms"; }
  [[nodiscard]] std::vector<std::string> effects() const override;
  [[nodiscard]] std::vector<NotObservable> not_observable() const override;
  [[nodiscard]] double material_share(const std::string& /*effect*/) const override { return kMaterial; }
  [[nodiscard]] ResponseFit fit(const std::vector<std::string>& effects) const override;
  [[nodiscard]] std::unique_ptr<ResponseModel> surrogate(const std::vector<std::string>& effects,
                                                         std::uint64_t seed) const override;

  // Time of every frame from 0 to the last, s after the first, under the model with these effects.
  [[nodiscard]] std::vector<double> frame_times_s(const std::vector<std::string>& effects, std::size_t n_frames) const;

  [[nodiscard]] std::size_t n_readings() const noexcept { return static_cast<std::size_t>(frame_.size()); }
  [[nodiscard]] std::size_t n_misread() const noexcept { return n_misread_; }
  [[nodiscard]] double scatter_s() const noexcept { return sigma_s_; }

 private:
  ClockModel(const ClockModel& other, Eigen::VectorXd reading_s);  // the same frames with other readings

  struct Solution;
  [[nodiscard]] Solution solve(const std::vector<std::string>& effects, Eigen::Index from, Eigen::Index to) const;
  [[nodiscard]] std::string describe(const Eigen::VectorXd& residual_s) const;

  DeclaredTime declared_;
  Eigen::VectorXd frame_, reading_s_;  // misread ones excluded
  double sigma_s_ = 0.0;
  std::size_t n_misread_ = 0;
};

}  // namespace core::closure
