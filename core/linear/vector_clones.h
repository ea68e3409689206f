#pragma once

// HOVERMODAL_VECTOR_CLONES before a function compiles it for wider vector units too and picks one when the program
// starts. Only for loops whose every element is computed by itself: vector width then changes no bit of the result
// (contraction to fused multiply-add is off). Sanitizers cannot instrument the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(HOVERMODAL_NO_VECTOR_CLONES) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HOVERMODAL_VECTOR_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define HOVERMODAL_VECTOR_CLONES
#endif
