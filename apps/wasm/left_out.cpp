// SPDX-License-Identifier: Apache-2.0
// These parts of the library are left out of this build, while other parts call them. A caller gets an Error that says
// so.
#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/baselines/negative_lobes.h>
#include <burnish/render/gl/surface_environment.h>

namespace burnish {

BaselineFit fit_baseline(BrdfRef, const SampleSource&, std::string_view, const BaselineOptions&) {
  throw Error("baselines: expected the command line, found WebAssembly, which fits none");
}

std::span<const std::string_view> baseline_methods() {
  return {};
}

NegativeLobes negative_lobes(const SeparableBrdf&, const Scorer&) {
  throw Error("baselines: expected the command line, found WebAssembly, which fits none");
}

SurfaceLight::SurfaceLight(const FactoredBrdf&, const Environment&) {
  throw Error("environment: expected the command line, found WebAssembly, which exports none");
}

int SurfaceLight::fetches() const noexcept {
  return 0;
}

LightShader SurfaceLight::shader(ShaderLanguage, const std::string&) const {
  return {};
}

}  // namespace burnish
