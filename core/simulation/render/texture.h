#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/simulation/render/texture_pattern.h"
#include "core/simulation/scene.h"

namespace core::simulation {

// A grey-level function of the plane, defined everywhere and evaluated exactly: a cubic B-spline with independent
// Gaussian coefficients, and those of a pattern, periodic over n x n cells. Nothing is resampled, so shifts have no
// interpolation error.
class Texture {
 public:
  // One cell of a row y = const, value = p[0] + s (p[1] + s (p[2] + s p[3])), 0 <= s < 1 across the cell.
  struct Cell {
    float p[4];
  };

  // cells: power of two. Coefficients come from the stream (seed, name, index), and from `pattern`, where there is one.
  Texture(const TextureParameters& texture, int cells, std::uint64_t seed, std::string_view name,
          std::uint64_t index = 0, const TexturePattern& pattern = {});

  [[nodiscard]] double pitch_mm() const noexcept { return pitch_mm_; }
  [[nodiscard]] double period_mm() const noexcept { return static_cast<double>(n_) * pitch_mm_; }
  [[nodiscard]] double mean() const noexcept { return mean_; }
  [[nodiscard]] double value(double x_mm, double y_mm) const noexcept;
  // Value at each of kLook points, given in cells (mm / pitch), |x|, |y| below 1e7.
  static constexpr int kLook = 16;
  void look(const double* x, const double* y, float* value) const noexcept;
  // Cells first .. first + count - 1 of the row at y; cell c spans x = c pitch .. (c + 1) pitch.
  void row(double y_mm, std::int64_t first, std::int64_t count, Cell* cells) const noexcept;

 private:
  [[nodiscard]] const float* coefficients(std::int64_t row) const noexcept;

  double pitch_mm_;
  std::int64_t n_, stride_;
  std::vector<float> coefficient_;  // n rows of n, grey levels around the mean, which is added on evaluation; each row
                                    // repeats its first three at its end, so that four in a line never wrap
  double mean_;
};

}  // namespace core::simulation
