#pragma once

#include <Eigen/SparseCore>
#include <string>

namespace drivers {

// A matrix in MatrixMarket's coordinate or array format (real or integer; general or symmetric: the other triangle is
// added). At most Limits::kMatrixBytes, kMatrixRows and kMatrixEntries; bytes are checked before anything is read.
// Throws FileError "FILE:LINE: what; remedy".
[[nodiscard]] Eigen::SparseMatrix<double> read_matrix_market(const std::string& path);

}  // namespace drivers
