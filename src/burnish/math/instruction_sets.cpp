// What Highway's headers call of its library, so that evaluation links no other: which sets of instructions the
// processor has, and which of them was chosen. Kernels are compiled for the sets of highway_targets.h alone; nothing
// else is told apart here.
#include <atomic>
#include <cstdint>
#include <initializer_list>

#include <burnish/math/highway_targets.h>

// after the list of its targets
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

// Zeros where the processor does not know the leaf.
Registers cpuid(unsigned leaf) {
  Registers r;
  __get_cpuid_count(leaf, 0, &r.a, &r.b, &r.c, &r.d);
  return r;
}

// Which registers the system keeps for each thread; only where the processor says that it may be asked.
std::uint32_t kept_registers() {
  std::uint32_t low, high;
  asm("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
  return low;
}

bool has(std::uint32_t found, std::uint32_t wanted) {
  return (found & wanted) == wanted;
}

// Highway's conditions for its targets, by the processor's manual.
std::int64_t detected() {
  // SSSE3, SSE4.1, SSE4.2, carry-less products, AES
  constexpr auto kSse4 = bits({9, 19, 20, 1, 25});
  // FMA, AVX, half floats, and that kept_registers may be asked; then BMI, AVX2, BMI2; and LZCNT
  constexpr auto kAvx = bits({12, 28, 29, 27}), kAvx2 = bits({3, 5, 8}), kLzcnt = bits({5});
  // F, DQ, CD, BW, VL
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
