// SPDX-License-Identifier: Apache-2.0
// This file stands in for libunwind where the compiler is older than LLVM 15. The compiler then writes the landing pad
// of an exception into one place for all threads. libunwind with threads reads a place of each thread, so no catch by
// type finds its exception. Here both use the one place. Therefore only one thread at a time may catch by type: the
// caller of loops. Bodies of loops catch nothing or everything, since catch (...) asks for no type.
//
// The Itanium C++ ABI and, for WebAssembly, LLVM's pass WasmEHPrepare define these functions.
#if __clang_major__ < 15

#include <cstdint>

extern "C" {

struct LandingPad {
  std::uintptr_t index, types;  // the pad's number in its function, and the function's table of types
  std::uintptr_t chosen;        // the catch that is chosen
};
LandingPad __wasm_lpad_context;

struct Thrown {
  std::uint64_t of_language;
  void (*destroy)(int reason, Thrown* self);
};

// This function of libc++abi looks for the type that catches.
int __gxx_personality_wasm0(int version, int actions, std::uint64_t of_language, Thrown* thrown,
                            LandingPad* at);

int _Unwind_CallPersonality(void* exception) {
  constexpr int kVersion = 1, kCleanupPhase = 2;
  auto* const thrown = static_cast<Thrown*>(exception);
  __wasm_lpad_context.chosen = 0;
  return __gxx_personality_wasm0(kVersion, kCleanupPhase, thrown->of_language, thrown, &__wasm_lpad_context);
}

int _Unwind_RaiseException(Thrown* thrown) {
  __builtin_wasm_throw(0, thrown);
}

void _Unwind_DeleteException(Thrown* thrown) {
  constexpr int kForeignCaught = 1;
  if (thrown->destroy) thrown->destroy(kForeignCaught, thrown);
}

// The register of the type is the only one that is written.
void _Unwind_SetGR(LandingPad* at, int which, std::uintptr_t value) {
  if (which == 1) at->chosen = value;
}
void _Unwind_SetIP(LandingPad*, std::uintptr_t) {}
// Returns the index from 1, plus one: the reader subtracts one, as from a return address.
std::uintptr_t _Unwind_GetIP(LandingPad* at) {
  return at->index + 2;
}
std::uintptr_t _Unwind_GetLanguageSpecificData(LandingPad* at) {
  return at->types;
}
std::uintptr_t _Unwind_GetRegionStart(LandingPad*) {
  return 0;
}

}  // extern "C"

#endif
