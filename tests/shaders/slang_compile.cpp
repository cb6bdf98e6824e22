// SPDX-License-Identifier: Apache-2.0
// Compiles shaders `main` with Slang's library, fragment shaders or, for CUDA, kernels: slang_compile LIBRARY TARGET
// FILE... It writes FILE.TARGET, and prints Slang's message for each file that it refuses. It exits with 1 if Slang
// refused a file. compile.py builds and runs it. Slang's objects live until the process ends.

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include <dlfcn.h>

#include "slang.h"

namespace {

const char* text_of(slang::IBlob* said) {
  return said ? static_cast<const char*>(said->getBufferPointer()) : "no reason given";
}

// Returns the code, or null after it printed the reason.
slang::IBlob* compiled(slang::ISession* session, const std::string& file, SlangStage stage) {
  std::ifstream in(file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  slang::IBlob *said = nullptr, *code = nullptr;
  slang::IModule* module =
      session->loadModuleFromSourceString(file.c_str(), file.c_str(), text.c_str(), &said);
  slang::IEntryPoint* entry = nullptr;
  if (module) module->findAndCheckEntryPoint("main", stage, &entry, &said);
  slang::IComponentType *program = nullptr, *linked = nullptr;
  if (entry) {
    slang::IComponentType* parts[] = {module, entry};
    session->createCompositeComponentType(parts, 2, &program, &said);
  }
  if (program) program->link(&linked, &said);
  if (linked) linked->getEntryPointCode(0, 0, &code, &said);
  // A zero byte ends each message, which may have several lines.
  if (!code) std::printf("%s: %s\n%c", file.c_str(), text_of(said), 0);
  return code;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) return 2;
  void* const library = dlopen(words[1], RTLD_NOW);
  using Create = SlangResult(const SlangGlobalSessionDesc*, slang::IGlobalSession**);
  auto* const create =
      library ? reinterpret_cast<Create*>(dlsym(library, "slang_createGlobalSession2")) : nullptr;
  slang::IGlobalSession* slang = nullptr;
  const SlangGlobalSessionDesc defaults{};
  if (!create || SLANG_FAILED(create(&defaults, &slang))) {
    std::printf("%s: expected Slang's library, found none\n", words[1]);
    return 2;
  }
  // Targets have slangc's names. SPIR-V and other targets need a profile of their own.
  const std::string target = words[2];
  slang::TargetDesc to{};
  to.format = target == "spirv"   ? SLANG_SPIRV
              : target == "hlsl"  ? SLANG_HLSL
              : target == "metal" ? SLANG_METAL
              : target == "wgsl"  ? SLANG_WGSL
              : target == "cuda"  ? SLANG_CUDA_SOURCE
                                  : SLANG_GLSL;
  if (target == "hlsl") to.profile = slang->findProfile("sm_6_0");
  if (target == "glsl") to.profile = slang->findProfile("glsl_450");
  int failures = 0;
  for (int i = 3; i < count; ++i) {
    slang::SessionDesc desc{};
    desc.targets = &to;
    desc.targetCount = 1;
    slang::ISession* session = nullptr;
    slang->createSession(desc, &session);
    slang::IBlob* const code =
        compiled(session, words[i], target == "cuda" ? SLANG_STAGE_COMPUTE : SLANG_STAGE_FRAGMENT);
    failures += !code;
    if (code)
      std::ofstream(std::string(words[i]) + "." + target, std::ios::binary)
          .write(static_cast<const char*>(code->getBufferPointer()),
                 static_cast<std::streamsize>(code->getBufferSize()));
  }
  return failures > 0;
}
