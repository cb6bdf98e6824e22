// Highway as it is used here, for kernels compiled once for each set of instructions. No include guard: each time the
// compiler comes by, it is for another set. A file of kernels starts with
//   #define HWY_TARGET_INCLUDE "burnish/FOLDER/FILE.cpp"
//   #include <burnish/math/highway-inl.h>
// before any other header of Highway, and has what is compiled anew between BURNISH_BEGIN_TARGET and
// BURNISH_END_TARGET; so have headers for such files, between guards that Highway's toggle opens again.

#include <burnish/math/highway_targets.h>

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
