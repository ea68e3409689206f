#pragma once

// HOVERMODAL_VECTOR_CLONES before a function also compiles it for wider vector units; one version is selected at
// program start. Only for loops whose elements are independent: the vector width then does not change the result by a
// bit (contraction to fused multiply-add is off). Sanitizers cannot instrument the selection.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(HOVERMODAL_NO_VECTOR_CLONES) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HOVERMODAL_VECTOR_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define HOVERMODAL_VECTOR_CLONES
#endif
