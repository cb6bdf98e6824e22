#pragma once

// Before any header of Highway. Vectors whose size is unknown when compiling cannot be members of a struct;
// those processors have a fixed set too. SSSE3 and AVX3_DL bring nothing over their neighbours here.
#define HWY_DISABLED_TARGETS \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL)
