// Eigen as the project compiles it (tools/cmake/CompileOptions.cmake) gives the same bits on amd64 and arm64, whatever
// the processor's caches and vectors. The numbers are those of amd64 with SSE2.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <complex>
#include <cstdint>
#include <cstring>
#include <random>

namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;

// FNV-1a over the numbers, 64 bits at a time.
template <class Matrix>
std::uint64_t hash_of(const Matrix& matrix) {
  const auto* values = reinterpret_cast<const double*>(matrix.data());
  constexpr std::size_t kParts = Eigen::NumTraits<typename Matrix::Scalar>::IsComplex ? 2 : 1;
  const std::size_t n = kParts * static_cast<std::size_t>(matrix.size());
  std::uint64_t hash = 1469598103934665603U;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    hash = (hash ^ bits) * 1099511628211U;
  }
  return hash;
}

class SameBits : public ::testing::Test {
 protected:
  SameBits() {
    for (MatrixXd* matrix : {&wide_, &tall_, &square_}) {
      for (double& value : matrix->reshaped()) value = next();
    }
    for (std::complex<double>& value : complex_.reshaped()) {
      const double real = next();
      value = {real, next()};
    }
  }

  std::mt19937_64 random_{1};
  double next() { return static_cast<double>(random_() >> 11U) / 9007199254740992.0 - 0.5; }

  MatrixXd wide_{37, 1000}, tall_{1000, 29}, square_{60, 60};
  MatrixXcd complex_{24, 24};
};

// A thousand terms are summed in blocks.
TEST_F(SameBits, OfProducts) {
  EXPECT_EQ(hash_of(MatrixXd(wide_ * tall_)), 0x24b8d9e9e5859606U);
  EXPECT_EQ(hash_of(MatrixXd(wide_.leftCols(300) * tall_.topRows(300))), 0x214cac49f2a515e4U);
  EXPECT_EQ(hash_of(MatrixXd(wide_ * wide_.transpose())), 0x0a72c5db95ab3d44U);
  EXPECT_EQ(hash_of(MatrixXd(wide_ * tall_.col(3))), 0x86a761876c5195c2U);
  EXPECT_EQ(hash_of(MatrixXd(tall_.transpose() * wide_.row(2).transpose())), 0xce4cd8978ab81ebbU);
  EXPECT_EQ(hash_of(MatrixXcd(complex_ * complex_)), 0x4493ff4c3cf5a971U);
}

TEST_F(SameBits, OfDecompositions) {
  const MatrixXd positive = square_ * square_.transpose() + MatrixXd::Identity(60, 60);
  EXPECT_EQ(hash_of(MatrixXd(positive.llt().matrixL())), 0x09de03ed93d91e36U);
  EXPECT_EQ(hash_of(MatrixXd(positive.ldlt().matrixLDLT())), 0xb412e10995ea12b8U);
  EXPECT_EQ(hash_of(MatrixXd(tall_.householderQr().matrixQR())), 0x00b27d2418046e9dU);
  EXPECT_EQ(hash_of(MatrixXd(tall_.colPivHouseholderQr().matrixQR())), 0xc1abaab635739068U);
  EXPECT_EQ(hash_of(MatrixXd(Eigen::SelfAdjointEigenSolver<MatrixXd>(positive).eigenvectors())), 0xe822406cf03e7b0fU);
  EXPECT_EQ(hash_of(MatrixXd(Eigen::JacobiSVD<MatrixXd>(square_).singularValues())), 0x6814124ebd22c0faU);
  EXPECT_EQ(hash_of(MatrixXd(Eigen::BDCSVD<MatrixXd>(square_).singularValues())), 0xb43e9c43c1afc4dbU);
  EXPECT_EQ(hash_of(MatrixXcd(complex_.partialPivLu().matrixLU())), 0x03311b359bee1378U);
}

}  // namespace
