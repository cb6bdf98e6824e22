// SPDX-License-Identifier: Apache-2.0
// Highway as it is used here, for kernels compiled once for each set of instructions. No include guard: each time the
// compiler comes by, it is for another set. A file of kernels starts with
//   #define HWY_TARGET_INCLUDE "burnish/FOLDER/FILE.cpp"
//   #include <burnish/math/highway-inl.h>
// before any other header of Highway, and has what is compiled anew between
//   HWY_BEFORE_NAMESPACE();
//   BURNISH_BEGIN_TARGET;
// and
//   BURNISH_END_TARGET;
//   HWY_AFTER_NAMESPACE();
// So have headers for such files, between guards that Highway's toggle opens again. The pragmas of HWY_BEFORE_NAMESPACE
// are no part of the second macro: g++ 14 puts them elsewhere in it, and loses what follows.

#include <burnish/math/highway_targets.h>

// clang-format off
#define BURNISH_BEGIN_TARGET \
  namespace burnish {        \
  namespace HWY_NAMESPACE {  \
  namespace {                \
  namespace hn = hwy::HWY_NAMESPACE
#define BURNISH_END_TARGET \
  }                        \
  }                        \
  }                        \
  static_assert(true)
// clang-format on

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>
