// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/export/manifest.h>
#include <burnish/export/sampler_files.h>
#include <burnish/shaders/cost_json.h>
#include <burnish/shaders/sampler_shader.h>
#include <burnish/textures/ktx2.h>

namespace burnish {

void add_sampler(BrdfRef brdf, const ExportOptions& options, ExportedFiles& result,
                 nlohmann::json& manifest) {
  if (std::ranges::none_of(options.to, is_language))
    throw Error("export: expected a shader language that draws directions, found " + names_of(options.to));
  const TabulatedSampler sampler(brdf);
  nlohmann::json entry{{"table_bytes", sampler.bytes()}};
  const std::string name = options.name + ".sample",
                    function = fmt::format("burnish_{}_sample", options.name),
                    pdf = fmt::format("burnish_{}_pdf", options.name);
  ShaderTexture texture;
  for (const ShaderLanguage language : kShaderLanguages) {
    if (std::ranges::find(options.to, language, language_of) == options.to.end()) continue;
    SamplerShader shader = generate_shader(sampler.tables(), language, options.name, options.places);
    const std::string file = shader_file(language, name);
    result.files.push_back({file, std::move(shader.text)});
    result.shaders.push_back({file, "a draw", shader.sample_cost});
    result.shaders.push_back({file, "a density", shader.pdf_cost});
    entry["shaders"].push_back({{"language", to_string(language)},
                                {"file", file},
                                {"functions", {function, pdf, function + "_world", pdf + "_world"}},
                                {"sample_cost", cost_json(shader.sample_cost)},
                                {"pdf_cost", cost_json(shader.pdf_cost)}});
    if (language != ShaderLanguage::cpp) texture = std::move(shader.texture);  // the same for all
  }
  if (texture.height > 0) {
    const Texture stored{.format = texture.format,
                         .channels = texture.channels,
                         .width = texture.width,
                         .height = texture.height,
                         .depth = 0,
                         .levels = {std::move(texture.values)}};
    const std::string file = name + ".ktx2";
    result.files.push_back({file, encode_ktx2(stored, options.compressed)});
    entry["texture"] = manifest_entry(file, stored);
    entry["texture"]["sampler"] = texture.name;
    entry["texture"]["filter"] = "any";
  }
  manifest["sample"] = std::move(entry);
}

}  // namespace burnish
