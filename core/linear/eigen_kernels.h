#pragma once

#include <Eigen/Dense>
#include <complex>

// Eigen's products, triangular solvers and decompositions of dynamic matrices, compiled once, in eigen_kernels.cpp;
// every source that multiplies matrices would compile them again. This header belongs to the precompiled headers of
// targets that link hovermodal_core. A source that does not include it compiles its own copy of the same code. The
// names are those of Eigen 3.4; other versions are left as they are.
#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)
#define HOVERMODAL_EIGEN_KERNELS

namespace core {

struct EigenKernels {
  using Index = Eigen::Index;
  using Complex = std::complex<double>;
  using Block = Eigen::Block<Eigen::MatrixXd, -1, -1, false>;
  using ColumnTail = Eigen::Block<const Eigen::MatrixXd, -1, 1, false>;
  using BlockTail = Eigen::VectorBlock<Eigen::Block<Eigen::MatrixXd, -1, 1, true>, -1>;
  using Coefficients = Eigen::VectorBlock<const Eigen::VectorXd, -1>;
  template <typename Scalar>
  using Traits = Eigen::internal::gebp_traits<Scalar, Scalar>;
  template <typename Scalar>
  using LeftPacket = typename Traits<Scalar>::LhsPacket4Packing;
  template <typename Scalar, int order>
  using In = Eigen::internal::const_blas_data_mapper<Scalar, Index, order>;
  template <typename Scalar>
  using Out = Eigen::internal::blas_data_mapper<Scalar, Index, Eigen::ColMajor, Eigen::Unaligned, 1>;
};

}  // namespace core

// The list, with STRUCT for class templates and FUNCTION for function templates.
// clang-format off
#define HOVERMODAL_EIGEN_PRODUCTS(STRUCT, Scalar) \
  STRUCT(gebp_kernel<Scalar, Scalar, Eigen::Index, core::EigenKernels::Out<Scalar>, core::EigenKernels::Traits<Scalar>::mr, core::EigenKernels::Traits<Scalar>::nr, false, false>) \
  STRUCT(gemm_pack_lhs<Scalar, Eigen::Index, core::EigenKernels::In<Scalar, 0>, core::EigenKernels::Traits<Scalar>::mr, core::EigenKernels::Traits<Scalar>::LhsProgress, core::EigenKernels::LeftPacket<Scalar>, 0, false, false>) \
  STRUCT(gemm_pack_lhs<Scalar, Eigen::Index, core::EigenKernels::In<Scalar, 1>, core::EigenKernels::Traits<Scalar>::mr, core::EigenKernels::Traits<Scalar>::LhsProgress, core::EigenKernels::LeftPacket<Scalar>, 1, false, false>) \
  STRUCT(gemm_pack_lhs<Scalar, Eigen::Index, core::EigenKernels::Out<Scalar>, core::EigenKernels::Traits<Scalar>::mr, core::EigenKernels::Traits<Scalar>::LhsProgress, core::EigenKernels::LeftPacket<Scalar>, 0, false, true>) \
  STRUCT(gemm_pack_rhs<Scalar, Eigen::Index, core::EigenKernels::In<Scalar, 0>, core::EigenKernels::Traits<Scalar>::nr, 0, false, false>) \
  STRUCT(gemm_pack_rhs<Scalar, Eigen::Index, core::EigenKernels::In<Scalar, 1>, core::EigenKernels::Traits<Scalar>::nr, 1, false, false>) \
  STRUCT(gemm_pack_rhs<Scalar, Eigen::Index, core::EigenKernels::Out<Scalar>, core::EigenKernels::Traits<Scalar>::nr, 0, false, false>) \
  STRUCT(gemm_pack_rhs<Scalar, Eigen::Index, core::EigenKernels::In<Scalar, 0>, core::EigenKernels::Traits<Scalar>::nr, 0, false, true>) \
  STRUCT(gemm_pack_rhs<Scalar, Eigen::Index, core::EigenKernels::In<Scalar, 1>, core::EigenKernels::Traits<Scalar>::nr, 1, false, true>) \
  STRUCT(gemm_pack_rhs<Scalar, Eigen::Index, core::EigenKernels::Out<Scalar>, core::EigenKernels::Traits<Scalar>::nr, 0, false, true>) \
  STRUCT(general_matrix_matrix_product<Eigen::Index, Scalar, 0, false, Scalar, 0, false, 0, 1>) \
  STRUCT(general_matrix_matrix_product<Eigen::Index, Scalar, 0, false, Scalar, 1, false, 0, 1>) \
  STRUCT(general_matrix_matrix_product<Eigen::Index, Scalar, 1, false, Scalar, 0, false, 0, 1>) \
  STRUCT(general_matrix_vector_product<Eigen::Index, Scalar, core::EigenKernels::In<Scalar, 0>, 0, false, Scalar, core::EigenKernels::In<Scalar, 0>, false, 0>) \
  STRUCT(general_matrix_vector_product<Eigen::Index, Scalar, core::EigenKernels::In<Scalar, 0>, 0, false, Scalar, core::EigenKernels::In<Scalar, 1>, false, 0>) \
  STRUCT(general_matrix_vector_product<Eigen::Index, Scalar, core::EigenKernels::In<Scalar, 1>, 1, false, Scalar, core::EigenKernels::In<Scalar, 0>, false, 0>) \
  STRUCT(general_matrix_vector_product<Eigen::Index, Scalar, core::EigenKernels::In<Scalar, 1>, 1, false, Scalar, core::EigenKernels::In<Scalar, 1>, false, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::Lower, false, 0, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::Upper, false, 0, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::Upper, false, 1, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::UnitLower, false, 0, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::UnitUpper, false, 1, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheRight, Eigen::Lower, false, 0, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheRight, Eigen::Upper, false, 1, 0, 1>) \
  STRUCT(triangular_solve_matrix<Scalar, Eigen::Index, Eigen::OnTheRight, Eigen::UnitUpper, false, 1, 0, 1>) \
  STRUCT(triangular_solve_vector<Scalar, Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::UnitLower, false, 0>) \
  STRUCT(triangular_solve_vector<Scalar, Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::Upper, false, 0>) \
  STRUCT(triangular_solve_vector<Scalar, Scalar, Eigen::Index, Eigen::OnTheLeft, Eigen::UnitUpper, false, 1>)
#define HOVERMODAL_EIGEN_STRUCTS(STRUCT) \
  HOVERMODAL_EIGEN_PRODUCTS(STRUCT, double) \
  HOVERMODAL_EIGEN_PRODUCTS(STRUCT, core::EigenKernels::Complex) \
  STRUCT(general_matrix_vector_product<Eigen::Index, double, core::EigenKernels::In<double, 0>, 0, false, core::EigenKernels::Complex, core::EigenKernels::In<core::EigenKernels::Complex, 1>, false, 0>) \
  STRUCT(general_matrix_matrix_triangular_product<Eigen::Index, double, 0, false, double, 1, false, 0, 1, Eigen::Lower, 0>) \
  STRUCT(selfadjoint_matrix_vector_product<double, Eigen::Index, 0, Eigen::Lower, false, false, 0>) \
  STRUCT(product_triangular_matrix_matrix<double, Eigen::Index, Eigen::Lower, true, 0, false, 0, false, 0, 1, 0>) \
  STRUCT(product_triangular_matrix_matrix<double, Eigen::Index, Eigen::Upper, true, 1, false, 0, false, 0, 1, 0>) \
  STRUCT(product_triangular_matrix_matrix<double, Eigen::Index, Eigen::UnitLower, true, 0, false, 0, false, 0, 1, 0>) \
  STRUCT(product_triangular_matrix_matrix<double, Eigen::Index, Eigen::UnitUpper, true, 1, false, 0, false, 0, 1, 0>)
#define HOVERMODAL_EIGEN_FUNCTIONS(FUNCTION) \
  FUNCTION(void Eigen::internal::evaluateProductBlockingSizesHeuristic<double, double, 1, Eigen::Index>(Eigen::Index&, Eigen::Index&, Eigen::Index&, Eigen::Index)) \
  FUNCTION(void Eigen::internal::evaluateProductBlockingSizesHeuristic<double, double, 4, Eigen::Index>(Eigen::Index&, Eigen::Index&, Eigen::Index&, Eigen::Index)) \
  FUNCTION(void Eigen::internal::apply_block_householder_on_the_left(core::EigenKernels::Block&, const core::EigenKernels::Block&, const core::EigenKernels::Coefficients&, bool)) \
  FUNCTION(void Eigen::MatrixBase<core::EigenKernels::Block>::applyHouseholderOnTheLeft<core::EigenKernels::ColumnTail>(const core::EigenKernels::ColumnTail&, const double&, double*)) \
  FUNCTION(void Eigen::MatrixBase<core::EigenKernels::Block>::applyHouseholderOnTheRight<core::EigenKernels::ColumnTail>(const core::EigenKernels::ColumnTail&, const double&, double*)) \
  FUNCTION(void Eigen::MatrixBase<core::EigenKernels::Block>::applyHouseholderOnTheLeft<core::EigenKernels::BlockTail>(const core::EigenKernels::BlockTail&, const double&, double*)) \
  FUNCTION(bool Eigen::internal::ldlt_inplace<Eigen::Lower>::unblocked(Eigen::MatrixXd&, Eigen::LDLT<Eigen::MatrixXd>::TranspositionType&, \
                                                                       Eigen::VectorXd&, Eigen::internal::SignMatrix&)) \
  FUNCTION(Eigen::Index Eigen::internal::llt_inplace<double, Eigen::Lower>::blocked(Eigen::MatrixXd&))
#define HOVERMODAL_EIGEN_DECOMPOSITIONS(CLASS) \
  CLASS(ColPivHouseholderQR<Eigen::MatrixXd>) \
  CLASS(HouseholderQR<Eigen::MatrixXd>) \
  CLASS(PartialPivLU<Eigen::MatrixXd>) \
  CLASS(JacobiSVD<Eigen::MatrixXd, Eigen::ColPivHouseholderQRPreconditioner>) \
  CLASS(BDCSVD<Eigen::MatrixXd>)
// clang-format on

#define HOVERMODAL_EXTERN_STRUCT(...) extern template struct Eigen::internal::__VA_ARGS__;
#define HOVERMODAL_EXTERN_CLASS(...) extern template class Eigen::__VA_ARGS__;
#define HOVERMODAL_EXTERN_FUNCTION(...) extern template __VA_ARGS__;
HOVERMODAL_EIGEN_STRUCTS(HOVERMODAL_EXTERN_STRUCT)
HOVERMODAL_EIGEN_DECOMPOSITIONS(HOVERMODAL_EXTERN_CLASS)
HOVERMODAL_EIGEN_FUNCTIONS(HOVERMODAL_EXTERN_FUNCTION)
#undef HOVERMODAL_EXTERN_STRUCT
#undef HOVERMODAL_EXTERN_CLASS
#undef HOVERMODAL_EXTERN_FUNCTION

#endif
