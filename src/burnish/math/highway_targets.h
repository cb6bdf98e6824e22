// SPDX-License-Identifier: Apache-2.0
#pragma once

// The sets of instructions that kernels are compiled for; before any header of Highway.

// Vectors whose size is unknown when compiling cannot be members of a struct; those processors have a fixed set too.
// SSSE3 and what came after AVX3 bring nothing over their neighbours here. Tests run the best target only, and each
// takes as long to compile: SSE4 goes without sanitizers.
#ifdef __SANITIZE_ADDRESS__
#define BURNISH_UNTESTED_TARGETS HWY_SSE4
#else
#define BURNISH_UNTESTED_TARGETS 0
#endif
#define HWY_DISABLED_TARGETS                                                                             \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL | HWY_AVX3_ZEN4 | \
   HWY_AVX3_SPR | HWY_AVX10_2 | BURNISH_UNTESTED_TARGETS)

#include <hwy/detect_targets.h>

// Highway 1.0.3 has none of these, 1.2 only the first two.
#ifndef HWY_AVX3_ZEN4
#define HWY_AVX3_ZEN4 0
#endif
#ifndef HWY_AVX3_SPR
#define HWY_AVX3_SPR 0
#endif
#ifndef HWY_AVX10_2
#define HWY_AVX10_2 0
#endif

// True if vectors of 16 floats are AVX-512's in this pass. The better targets of x86 have lower numbers, and those of
// other processors higher ones.
#define BURNISH_TARGET_IS_AVX3 (HWY_TARGET <= HWY_AVX3)
