#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace core {

// Assigns rows to columns so that the sum of costs is minimal, where an unassigned row costs 1: a pair that costs 1 or
// more (or NaN) is never made. Hungarian method with potentials [Kuhn 1955; Munkres 1957], one augmenting path per row:
// O(rows^2 (rows + columns)). Unlike a greedy choice it does not give up one good pair for two bad ones where two modes
// move together. Memory is fixed at construction.
class Assignment {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  Assignment(std::size_t max_rows, std::size_t max_columns);

  // `cost`: n_rows x n_columns, row-major, >= 0. If a size exceeds that of the construction, nothing is paired. Returns
  // the column of every row or kNone; valid until the next call.
  [[nodiscard]] std::span<const std::size_t> solve(std::span<const double> cost, std::size_t n_rows,
                                                   std::size_t n_columns) noexcept;

 private:
  [[nodiscard]] double cost_of(std::size_t row, std::size_t column) const noexcept;
  void add_row(std::size_t row) noexcept;

  std::size_t max_rows_, max_columns_;
  std::span<const double> cost_;
  std::size_t n_rows_ = 0, n_real_ = 0, n_columns_ = 0;
  // Rows and columns count from 1 here: column 0 is the root of the search.
  std::vector<double> row_potential_, column_potential_, slack_;
  std::vector<std::size_t> row_of_column_, column_before_;
  std::vector<unsigned char> visited_;
  std::vector<std::size_t> column_of_row_;
};

}  // namespace core
