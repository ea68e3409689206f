#include "core/tracking/rest_rectangle.h"

#include <algorithm>
#include <cmath>

namespace core {
namespace {

constexpr int kRestCells = 40;  // along the picture's longer side

// Number of static points per cell; below 0: forbidden.
class Cells {
 public:
  Cells(int width_px, int height_px)
      : cell_px_(static_cast<double>(std::max(width_px, height_px)) / kRestCells),
        columns_(static_cast<int>(width_px / cell_px_)),
        rows_(static_cast<int>(height_px / cell_px_)),
        counts_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] double cell_px() const { return cell_px_; }
  [[nodiscard]] int& at(int row, int column) {
    return counts_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(column)];
  }
  void add(const Vector2& place) {
    const int row = std::clamp(static_cast<int>(place.v / cell_px_), 0, rows_ - 1);
    int& count = at(row, std::clamp(static_cast<int>(place.u / cell_px_), 0, columns_ - 1));
    if (count >= 0) ++count;
  }
  void forbid(double left, double top, double right, double bottom) {
    const auto cell = [&](double px, int n) {
      return std::clamp(static_cast<int>(std::floor(px / cell_px_)), 0, n - 1);
    };
    for (int row = cell(top, rows_); row <= cell(bottom, rows_); ++row) {
      for (int column = cell(left, columns_); column <= cell(right, columns_); ++column) at(row, column) = -1;
    }
  }

 private:
  double cell_px_;
  int columns_, rows_;
  std::vector<int> counts_;
};

// Rectangle of allowed cells with the most points; 40 x 40 cells need some 200 000 steps.
std::optional<Box> fullest(Cells& cells) {
  int best = 0;
  Box box;
  for (int top = 0; top < cells.rows(); ++top) {
    std::vector<int> below(static_cast<std::size_t>(cells.columns()), 0);  // points in the column; < 0: forbidden
    for (int bottom = top; bottom < std::min(cells.rows(), top + cells.rows() / 2); ++bottom) {
      int begin = 0, sum = 0;
      for (int column = 0; column < cells.columns(); ++column) {
        int& down = below[static_cast<std::size_t>(column)];
        const int here = cells.at(bottom, column);
        down = down < 0 || here < 0 ? -1 : down + here;
        if (down < 0) {
          begin = column + 1;
          sum = 0;
          continue;
        }
        sum += down;
        if (column - begin >= cells.columns() / 2) sum -= below[static_cast<std::size_t>(begin++)];
        if (sum <= best) continue;
        best = sum;
        box = {begin * cells.cell_px(), top * cells.cell_px(), (column + 1) * cells.cell_px(),
               (bottom + 1) * cells.cell_px()};
      }
    }
  }
  return best > 0 ? std::optional(box) : std::nullopt;
}

}  // namespace

std::optional<Box> rest_rectangle(const std::vector<SurveyedPoint>& points, const std::vector<bool>& rests,
                                  const std::vector<Region>& forbidden, int width_px, int height_px) {
  if (width_px < kRestCells || height_px < 2) return std::nullopt;
  Cells cells(width_px, height_px);
  const double margin = 0.5 * cells.cell_px();
  for (const Region& r : forbidden)
    cells.forbid(r.u_px - margin, r.v_px - margin, r.u_px + r.width_px + margin, r.v_px + r.height_px + margin);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2& at = points[i].at;
    if (!rests[i]) cells.forbid(at.u, at.v, at.u, at.v);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (rests[i]) cells.add(points[i].at);
  }
  return fullest(cells);
}

}  // namespace core
