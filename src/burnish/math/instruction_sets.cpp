// SPDX-License-Identifier: Apache-2.0
// Defines the functions of Highway's library that its headers call, so that evaluation links no other library. They
// report the sets of instructions that the processor has, and the chosen set. Kernels are compiled for the sets of
// highway_targets.h alone, so no other sets are distinguished.
#include <atomic>
#include <cstdint>
#include <initializer_list>

#include <burnish/math/highway_targets.h>

// This header follows the list of its targets.
#include <hwy/targets.h>

#if HWY_ARCH_X86
#include <cpuid.h>
#elif HWY_ARCH_ARM_A64 && defined(__linux__)
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

namespace hwy {

namespace {

#if HWY_ARCH_X86
constexpr std::uint32_t bits(std::initializer_list<int> numbers) {
  std::uint32_t mask = 0;
  for (const int number : numbers) mask |= std::uint32_t{1} << number;
  return mask;
}

struct Registers {
  unsigned a = 0, b = 0, c = 0, d = 0;
};

// Returns the registers of a leaf, zeros if the processor does not know it.
Registers cpuid(unsigned leaf) {
  Registers r;
  __get_cpuid_count(leaf, 0, &r.a, &r.b, &r.c, &r.d);
  return r;
}

// Returns a mask of the registers that the system keeps for each thread. It may be called only if the
// processor says so.
std::uint32_t kept_registers() {
  std::uint32_t low, high;
  asm("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

bool has(std::uint32_t found, std::uint32_t wanted) {
  return (found & wanted) == wanted;
}

// Returns the targets that the processor supports, by Highway's conditions and the processor's manual.
std::int64_t detected() {
  // These bits are SSSE3, SSE4.1, SSE4.2, carry-less products and AES.
  constexpr auto kSse4 = bits({9, 19, 20, 1, 25});
  // The first set is FMA, AVX, half floats, and permission to call kept_registers. The second is BMI, AVX2,
  // BMI2, the third LZCNT.
  constexpr auto kAvx = bits({12, 28, 29, 27}), kAvx2 = bits({3, 5, 8}), kLzcnt = bits({5});
  // These bits are F, DQ, CD, BW and VL.
  constexpr auto kAvx512 = bits({16, 17, 28, 30, 31});
  constexpr auto kKeptAvx = bits({1, 2}), kKeptAvx512 = bits({5, 6, 7});

  const Registers basic = cpuid(1), structured = cpuid(7), extended = cpuid(0x80000001);
  std::int64_t targets = 0;
  if (!has(basic.c, kSse4)) return targets;
  targets |= HWY_SSE4;
  if (!has(basic.c, kAvx) || !has(structured.b, kAvx2) || !has(extended.c, kLzcnt)) return targets;
  const std::uint32_t kept = kept_registers();
  if (!has(kept, kKeptAvx)) return targets;
  targets |= HWY_AVX2;
  if (has(structured.b, kAvx512) && has(kept, kKeptAvx512)) targets |= HWY_AVX3;
  return targets;
}
#elif HWY_ARCH_ARM_A64 && defined(__linux__)
std::int64_t detected() {
  return (getauxval(AT_HWCAP) & HWCAP_AES) != 0 ? HWY_NEON : 0;
}
#else
std::int64_t detected() {
  return 0;
}
#endif

std::atomic<std::int64_t> disabled = 0, only_for_test = 0;

}  // namespace

std::int64_t SupportedTargets() {
  static const std::int64_t found = detected() | HWY_STATIC_TARGET;
  const std::int64_t only = only_for_test;
  const std::int64_t targets = (only != 0 ? only : found) & ~disabled;
  return targets != 0 ? targets : HWY_STATIC_TARGET;
}

void DisableTargets(std::int64_t targets) {
  disabled = targets;
  GetChosenTarget().DeInit();
}

void SetSupportedTargetsForTest(std::int64_t targets) {
  only_for_test = targets;
  GetChosenTarget().DeInit();
}

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

}  // namespace hwy
