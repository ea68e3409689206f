#pragma once

// Read by Eigen inside its class DenseBase (EIGEN_DENSEBASE_PLUGIN), before its kernels for arm64. They multiply and
// add in one step; SSE2 has two, each with its rounding. With two steps and the register blocks of SSE2, the results
// are the same to the last bit.
#undef EIGEN_HAS_SINGLE_INSTRUCTION_MADD
#define vfmaq_f64(sum, a, b) vaddq_f64(sum, vmulq_f64(a, b))
#define vfmaq_n_f64(sum, a, b) vaddq_f64(sum, vmulq_n_f64(a, b))
#define vfmaq_laneq_f64(sum, a, b, lane) vaddq_f64(sum, vmulq_laneq_f64(a, b, lane))
