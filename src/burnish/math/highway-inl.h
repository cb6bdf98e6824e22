// Highway as it is used here, for kernels compiled once for each set of instructions. No include guard: each time the
// compiler comes by, it is for another set. A file of kernels starts with
//   #define HWY_TARGET_INCLUDE "burnish/FOLDER/FILE.cpp"
//   #include <burnish/math/highway-inl.h>
// before any other header of Highway, and has what is compiled anew between BURNISH_BEGIN_TARGET and BURNISH_END_TARGET;
// so have headers for such files, between guards that Highway's toggle opens again.

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

// clang-format off
#define BURNISH_BEGIN_TARGET \
  HWY_BEFORE_NAMESPACE();    \
  namespace burnish {        \
  namespace HWY_NAMESPACE {  \
  namespace {                \
  namespace hn = hwy::HWY_NAMESPACE
#define BURNISH_END_TARGET \
  }                        \
  }                        \
  }                        \
  HWY_AFTER_NAMESPACE()
// clang-format on

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>
