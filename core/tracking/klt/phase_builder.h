#pragma once

#include <array>

#include "core/tracking/klt/float_window.h"
#include "core/tracking/klt/phase.h"
#include "core/tracking/klt/shifted_windows.h"

namespace core {

// Makes a phase of a template from the windows of the displaced template.
class PhaseBuilder {
 public:
  // The undisplaced window with its margin; phase: in sixths of a pixel per axis. False: the window has no contrast.
  [[nodiscard]] bool begin(const WideWindow& window, int radius, int phase_u, int phase_v) noexcept;
  // The window displaced by a node, in sixths of a pixel from the phase, -kReach ... kReach.
  void add(int node_u, int node_v, const FloatWindow& window) noexcept;

  // Change of the products with the smoothed gradients (rows u, v) by a displacement (columns along u, along v).
  struct Response {
    double uu = 0.0, uv = 0.0, vu = 0.0, vv = 0.0;
  };
  // Needs the nodes on both axes.
  [[nodiscard]] Response response() const noexcept { return response_of(nodes_); }
  // own: white noise of the template in its window, grey^2. False: the response has no inverse. Needs all nodes.
  [[nodiscard]] bool finish(double own, Phase& out) const noexcept;
  // Energy of a deformation's effect that offset, gain and shift do not explain.
  [[nodiscard]] DeformationEnergy deformation_energy() const noexcept;

 private:
  static constexpr std::size_t kAll = std::size_t{kNodes} * kNodes;
  struct Node {
    double u = 0.0, v = 0.0;          // products with the smoothed gradients
    double same = 0.0, square = 0.0;  // with the texture, with itself
  };
  using Nodes = std::array<Node, kAll>;
  [[nodiscard]] static std::size_t at(int node_u, int node_v) noexcept {
    return static_cast<std::size_t>((node_v + kReach) * kNodes + node_u + kReach);
  }
  [[nodiscard]] static Response response_of(const Nodes& nodes) noexcept;
  [[nodiscard]] Nodes without_noise(double own) const noexcept;
  void keep_factors(const FloatWindow& step_u, const FloatWindow& step_v, Phase& out) const noexcept;
  void keep_pull(const FloatWindow& step_u, const FloatWindow& step_v, const Vector2& phase, Phase& out) const noexcept;
  [[nodiscard]] std::array<FloatWindow, 4> changes() const noexcept;

  int radius_ = kWindowRadius, phase_u_ = 0, phase_v_ = 0;
  double n_pixels_ = 1.0;
  FloatWindow texture_, smooth_u_, smooth_v_;  // about their means
  FloatWindow slope_u_, slope_v_;              // of the texture
  double square_ = 0.0;                        // of the texture
  Nodes nodes_;
};

}  // namespace core
