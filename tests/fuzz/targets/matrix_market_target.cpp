#include <Eigen/SparseCore>
#include <cmath>
#include <stdexcept>

#include "drivers/storage/limits.h"
#include "drivers/storage/matrix_market.h"
#include "tests/fuzz/memory_file.h"

namespace tests::fuzz {
namespace {

void run(Bytes bytes) {
  const MemoryFile file(bytes);
  Eigen::SparseMatrix<double> matrix;
  try {
    matrix = drivers::read_matrix_market(file.path());
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
    return;
  }
  require(matrix.rows() > 0 && matrix.cols() > 0, "a matrix has rows and columns");
  require(static_cast<std::size_t>(matrix.rows()) <= drivers::Limits::kMatrixRows, "rows are bounded");
  for (int c = 0; c < matrix.outerSize(); ++c) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, c); it; ++it) {
      require(it.row() >= 0 && it.row() < matrix.rows(), "entries lie within the matrix");
      require(std::isfinite(it.value()), "entries are numbers");
    }
  }
}

const Registration kTarget("matrix_market", &run);

}  // namespace
}  // namespace tests::fuzz
