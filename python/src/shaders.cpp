// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/shaders/shader.h>
#include <burnish/textures/ktx2.h>

#include "opened_brdf.h"
#include "texts.h"

namespace burnish::python {

namespace {

std::vector<std::string_view> language_names() {
  std::vector<std::string_view> names;
  for (const ShaderLanguage language : kShaderLanguages) names.push_back(to_string(language));
  return names;
}

ShaderLanguage language_of(const std::string& name) {
  for (const ShaderLanguage language : kShaderLanguages)
    if (to_string(language) == name) return language;
  throw Error(fmt::format("language: expected {}, found '{}'", fmt::join(language_names(), ", "), name));
}

Shader shader_of(const OpenedModel& model, const std::string& language, bool exact, bool half,
                 const std::string& name) {
  const ShaderLanguage wanted = language_of(language);
  const bool weighs = exact || wanted == ShaderLanguage::cpp;
  return generate_shader(model.brdf(),
                         {wanted, weighs ? ShaderFilter::exact : ShaderFilter::hardware, name, half});
}

void write_ktx2(const std::filesystem::path& path, const ShaderTexture& texture, bool compressed) {
  write_then_rename(path, encode_ktx2({.format = texture.format,
                                       .channels = texture.channels,
                                       .width = texture.width,
                                       .height = texture.height,
                                       .depth = texture.depth,
                                       .levels = {texture.values}},
                                      compressed));
}

}  // namespace

void bind_shaders(nb::module_& m) {
  nb::class_<PlacedTable>(m, "PlacedTable", "The place of a table in a texture.")
      .def_ro("table", &PlacedTable::table, "Index into Model.tables.")
      .def_ro("first", &PlacedTable::first, "x, y and z of the texel that holds the table's first node.")
      .def_ro("exponent", &PlacedTable::exponent, "The texels are the table's values times 2^exponent.")
      .def("__repr__", [](const PlacedTable& t) {
        return fmt::format("<burnish placed table {}: first texel ({}), times 2^{}>", t.table,
                           fmt::join(t.first, ", "), t.exponent);
      });
  nb::class_<ShaderTexture>(m, "ShaderTexture",
                            "A texture of a shader: tables beside, above or behind each other.")
      .def_ro("name", &ShaderTexture::name, "The name of the sampler in the shader.")
      .def_ro("tables", &ShaderTexture::tables)
      .def_prop_ro("format", [](const ShaderTexture& t) { return std::string(to_string(t.format)); })
      .def_prop_ro(
          "values",
          [](const ShaderTexture& t) {
            std::vector<std::size_t> shape;
            if (t.depth > 0) shape.push_back(static_cast<std::size_t>(t.depth));
            for (const int side : {t.height, t.width}) shape.push_back(static_cast<std::size_t>(side));
            shape.push_back(t.channels);
            return to_numpy(t.values, shape);
          },
          nb::sig("def values(self) -> numpy.ndarray"),
          "Texels, float32 (height, width, channels); the depth comes first where there is one.")
      .def("__repr__", [](const ShaderTexture& t) {
        return fmt::format("<burnish texture '{}': {} x {}{}, {}, {}, tables {}>", t.name, t.width, t.height,
                           t.depth > 0 ? fmt::format(" x {}", t.depth) : "", counted(t.channels, "channel"),
                           to_string(t.format), t.tables.size());
      });
  nb::class_<Shader>(m, "Shader", "Source text that evaluates a model, and the textures that the text reads.")
      .def_ro("text", &Shader::text, "The source text, without a #version line.")
      .def_ro("textures", &Shader::textures)
      .def_prop_ro(
          "cost",
          [](const Shader& s) {
            nb::dict cost;
            cost["fetches"] = s.cost.fetches;
            cost["textures"] = s.cost.textures;
            cost["operations"] = s.cost.operations;
            cost["divisions"] = s.cost.divisions;
            cost["roots"] = s.cost.roots;
            cost["powers"] = s.cost.powers;
            return cost;
          },
          nb::sig("def cost(self) -> dict[str, int]"),
          "The cost of one evaluation; operations are counted for each component.")
      .def("__repr__", [](const Shader& s) {
        return fmt::format("<burnish shader: {}, {}, {}>", counted(s.text.size(), "byte"),
                           counted(s.textures.size(), "texture"), to_string(s.cost));
      });
  m.def("generate_shader", &shader_of, nb::arg("model"), nb::arg("language") = "glsl", nb::kw_only(),
        nb::arg("exact") = false, nb::arg("half") = false, nb::arg("name") = "brdf",
        nb::call_guard<nb::gil_scoped_release>(),
        fmt::format(
            "Returns a shader of two functions, as `burnish export --to` writes them:\n"
            "burnish_NAME(wi, wo) returns f_r in 1/sr of unit vectors of the local frame;\n"
            "burnish_NAME_world(n, t, l, v) does the same of vectors of the world.\n"
            "\n"
            "language: {}; cpp has its tables inside.\n"
            "exact: the shader interpolates texels in floats, instead of the texture unit; cpp always does "
            "so.\n"
            "half: texels are multiplied in half precision (mediump, min16float, half, f16), within 1 %.\n"
            "Neither exact nor cpp allows it.",
            quoted_names(language_names(), "or"))
            .c_str());
  m.def("write_ktx2", &write_ktx2, nb::arg("path"), nb::arg("texture"), nb::kw_only(),
        nb::arg("compressed") = true, nb::call_guard<nb::gil_scoped_release>(),
        "Writes a shader's texture as a KTX2 file. compressed: compresses it by Zstandard.");
}

}  // namespace burnish::python
