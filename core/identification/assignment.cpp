#include "core/identification/assignment.h"

#include <algorithm>
#include <limits>

namespace core {

namespace {
constexpr double kAlone = 1.0;
constexpr double kForbidden = 1e6;
}  // namespace

// After the real columns every row has one extra column, which stands for "unassigned".
Assignment::Assignment(std::size_t max_rows, std::size_t max_columns)
    : max_rows_(max_rows),
      max_columns_(max_columns),
      row_potential_(max_rows + 1),
      column_potential_(max_rows + max_columns + 1),
      slack_(max_rows + max_columns + 1),
      row_of_column_(max_rows + max_columns + 1),
      column_before_(max_rows + max_columns + 1),
      visited_(max_rows + max_columns + 1),
      column_of_row_(max_rows) {}

double Assignment::cost_of(std::size_t row, std::size_t column) const noexcept {
  if (column > n_real_) return column - n_real_ == row ? kAlone : kForbidden;
  const double cost = cost_[(row - 1) * n_real_ + (column - 1)];
  return cost < kAlone ? cost : kForbidden;  // also if it is NaN
}

void Assignment::add_row(std::size_t row) noexcept {
  row_of_column_[0] = row;
  std::fill(slack_.begin(), slack_.end(), std::numeric_limits<double>::infinity());
  std::fill(visited_.begin(), visited_.end(), static_cast<unsigned char>(0));
  std::size_t column = 0;
  do {
    visited_[column] = 1;
    const std::size_t at_row = row_of_column_[column];
    double least = std::numeric_limits<double>::infinity();
    std::size_t next = 0;
    for (std::size_t j = 1; j <= n_columns_; ++j) {
      if (visited_[j] != 0) continue;
      const double reduced = cost_of(at_row, j) - row_potential_[at_row] - column_potential_[j];
      if (reduced < slack_[j]) slack_[j] = reduced, column_before_[j] = column;
      if (slack_[j] < least) least = slack_[j], next = j;
    }
    for (std::size_t j = 0; j <= n_columns_; ++j) {
      if (visited_[j] != 0) {
        row_potential_[row_of_column_[j]] += least;
        column_potential_[j] -= least;
      } else {
        slack_[j] -= least;
      }
    }
    column = next;
  } while (row_of_column_[column] != 0);
  while (column != 0) {  // back along the path: every row moves to the next column
    const std::size_t before = column_before_[column];
    row_of_column_[column] = row_of_column_[before];
    column = before;
  }
}

std::span<const std::size_t> Assignment::solve(std::span<const double> cost, std::size_t n_rows,
                                               std::size_t n_columns) noexcept {
  const std::span<std::size_t> out = std::span(column_of_row_).first(std::min(n_rows, max_rows_));
  std::fill(out.begin(), out.end(), kNone);
  if (n_rows > max_rows_ || n_columns > max_columns_ || cost.size() < n_rows * n_columns) return out;
  cost_ = cost;
  n_rows_ = n_rows, n_real_ = n_columns, n_columns_ = n_columns + n_rows;
  std::fill(row_potential_.begin(), row_potential_.end(), 0.0);
  std::fill(column_potential_.begin(), column_potential_.end(), 0.0);
  std::fill(row_of_column_.begin(), row_of_column_.end(), std::size_t{0});
  for (std::size_t row = 1; row <= n_rows; ++row) add_row(row);
  for (std::size_t j = 1; j <= n_columns; ++j) {
    const std::size_t row = row_of_column_[j];
    if (row != 0 && cost_of(row, j) < kAlone) out[row - 1] = j - 1;
  }
  return out;
}

}  // namespace core
