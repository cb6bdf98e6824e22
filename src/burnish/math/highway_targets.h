#pragma once

// The sets of instructions that kernels are compiled for; before any header of Highway.

// Vectors whose size is unknown when compiling cannot be members of a struct; those processors have a fixed set too.
// SSSE3 and AVX3_DL bring nothing over their neighbours here. Tests run the best target only, and each takes as long to
// compile: SSE4 goes without sanitizers.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_UNTESTED_TARGETS HWY_SSE4
#else
#define BURNISH_UNTESTED_TARGETS 0
#endif
#define HWY_DISABLED_TARGETS                                                             \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL | \
   BURNISH_UNTESTED_TARGETS)
