#include "core/identification/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/simulation/random_stream.h"

namespace core {
namespace {

constexpr std::size_t kNone = Assignment::kNone;

std::vector<std::size_t> solved(const std::vector<double>& cost, std::size_t n_rows, std::size_t n_columns) {
  Assignment assignment(8, 8);
  const auto columns = assignment.solve(cost, n_rows, n_columns);
  return {columns.begin(), columns.end()};
}

double total(const std::vector<double>& cost, const std::vector<std::size_t>& columns, std::size_t n_columns) {
  double sum = 0.0;
  for (std::size_t r = 0; r < columns.size(); ++r) sum += columns[r] == kNone ? 1.0 : cost[r * n_columns + columns[r]];
  return sum;
}

// The least total over all ways to pair rows with columns, by enumeration.
double least_total(const std::vector<double>& cost, std::size_t n_rows, std::size_t n_columns, std::size_t row = 0,
                   unsigned taken = 0) {
  if (row == n_rows) return 0.0;
  double least = 1.0 + least_total(cost, n_rows, n_columns, row + 1, taken);
  for (std::size_t c = 0; c < n_columns; ++c) {
    if ((taken >> c & 1U) != 0) continue;
    least = std::min(least, cost[row * n_columns + c] + least_total(cost, n_rows, n_columns, row + 1, taken | 1U << c));
  }
  return least;
}

TEST(Assignment, TakesTwoGoodPairsBeforeTheCheapestOne) {
  EXPECT_EQ(solved({0.3, 0.9, 0.1, 0.3}, 2, 2), (std::vector<std::size_t>{0, 1}));
}

TEST(Assignment, LeavesAloneWhatCostsMoreThanGoingAlone) {
  EXPECT_EQ(solved({1.0, 0.2, 5.0, 0.1}, 2, 2), (std::vector<std::size_t>{kNone, 1}));
}

TEST(Assignment, NeverPairsWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solved({nan, nan, 0.5, nan}, 2, 2), (std::vector<std::size_t>{kNone, 0}));
}

TEST(Assignment, TakesNoRowsNoColumnsAndTooMany) {
  EXPECT_TRUE(solved({}, 0, 0).empty());
  EXPECT_EQ(solved({}, 2, 0), (std::vector<std::size_t>{kNone, kNone}));
  EXPECT_EQ(solved(std::vector<double>(20, 0.1), 2, 10), (std::vector<std::size_t>{kNone, kNone}));
}

TEST(Assignment, IsAsCheapAsTheBestOfAllWays) {
  simulation::RandomStream random(1, "assignment");
  for (int trial = 0; trial < 400; ++trial) {
    const std::size_t n_rows = 1 + static_cast<std::size_t>(5.0 * random.uniform());
    const std::size_t n_columns = 1 + static_cast<std::size_t>(5.0 * random.uniform());
    std::vector<double> cost(n_rows * n_columns);
    for (double& c : cost) c = 1.4 * random.uniform();
    EXPECT_NEAR(total(cost, solved(cost, n_rows, n_columns), n_columns), least_total(cost, n_rows, n_columns), 1e-12);
  }
}

}  // namespace
}  // namespace core
