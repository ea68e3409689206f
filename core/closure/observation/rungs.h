#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace core::closure {

// The spectrum of a record in rungs: narrow where cameras drift (0, 0.25, 0.5, 1 Hz), then of 1 Hz each, the last up to
// half the frame rate. An amplitude per frame that exists in some rungs only costs the noise of those.
using RungSet = std::uint64_t;  // bit i: rung i
inline constexpr RungSet kAllRungs = ~RungSet{0};

class Rungs {
 public:
  static constexpr std::size_t kMost = 63;

  explicit Rungs(double rate_hz);

  [[nodiscard]] std::size_t size() const noexcept { return edges_hz_.size() - 1; }
  [[nodiscard]] double from_hz(std::size_t rung) const { return edges_hz_[rung]; }
  [[nodiscard]] double to_hz(std::size_t rung) const { return edges_hz_[rung + 1]; }
  [[nodiscard]] std::size_t of(double hz) const noexcept;  // the last one beyond half the rate
  [[nodiscard]] RungSet up_to(double hz) const noexcept;   // all that end there or below
  [[nodiscard]] double width_hz(RungSet set) const noexcept;
  [[nodiscard]] double highest_hz(RungSet set) const noexcept;
  [[nodiscard]] double lowest_hz(RungSet set) const noexcept;

  // Orthonormal cosines (DCT-II) of these rungs, frames x count.
  [[nodiscard]] Eigen::MatrixXd cosines(Eigen::Index n_frames, RungSet set) const;
  // Their orders, and the cosines of some of them.
  [[nodiscard]] std::vector<Eigen::Index> orders(Eigen::Index n_frames, RungSet set) const;
  [[nodiscard]] static Eigen::MatrixXd cosines(Eigen::Index n_frames, std::span<const Eigen::Index> orders);
  // The same cosines a few at a time: all cosines of a band take four times the memory of a residual.
  // use(first, cosines): those of orders[first] and the ones that follow.
  static void for_cosines(Eigen::Index n_frames, std::span<const Eigen::Index> orders,
                          const std::function<void(Eigen::Index first, const Eigen::MatrixXd& cosines)>& use);

 private:
  double rate_hz_;
  std::vector<double> edges_hz_;
};

[[nodiscard]] inline bool holds(RungSet set, std::size_t rung) noexcept { return (set >> rung & 1U) != 0; }

}  // namespace core::closure
