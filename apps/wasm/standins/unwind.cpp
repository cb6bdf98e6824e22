// In place of libunwind where the compiler is older than LLVM 15: it writes which landing pad an exception has come to
// into one place for all threads, libunwind of threads reads another a thread, and no catch of a type finds its own.
// Here both mean the one place. So of all threads one may catch by type at a time: the caller of loops, whose bodies
// catch nothing or everything (catch (...) asks for no type).
//
// What these functions have to do is told by the Itanium C++ ABI and, for WebAssembly, by LLVM's pass WasmEHPrepare.
#if __clang_major__ < 15

#include <cstdint>

extern "C" {

struct LandingPad {
  std::uintptr_t index, types;  // of the pad in its function, and the function's table of types
  std::uintptr_t chosen;        // which of them catches
};
LandingPad __wasm_lpad_context;

struct Thrown {
  std::uint64_t of_language;
  void (*destroy)(int reason, Thrown* self);
};

// libc++abi's, which looks for the type that catches
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

// The only register that is written is that of the type.
void _Unwind_SetGR(LandingPad* at, int which, std::uintptr_t value) {
  if (which == 1) at->chosen = value;
}
void _Unwind_SetIP(LandingPad*, std::uintptr_t) {}
// Pads count from 1, and the reader takes one off as of a return address.
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
