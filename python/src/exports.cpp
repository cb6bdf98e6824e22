// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/export/export_model.h>
#include <burnish/export/export_openpbr.h>
#include <burnish/export/export_specular.h>
#include <burnish/io/open_source.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/source.h>

#include "opened_brdf.h"
#include "texts.h"

namespace burnish::python {

namespace {

using Names = std::variant<std::string, std::vector<std::string>>;

std::vector<ExportTarget> targets_of(const Names& names) {
  if (const auto* one = std::get_if<std::string>(&names)) return {export_target(*one)};
  std::vector<ExportTarget> targets;
  for (const std::string& name : std::get<std::vector<std::string>>(names))
    targets.push_back(export_target(name));
  return targets;
}

// Returns the name of files and functions where none is given. It comes from the source: a file's stem, the name after
// '#' of a material in a file, or an analytic model.
std::string name_of(const std::string& source) {
  if (is_analytic_spec(source)) return export_name(source.substr(0, source.find(':')));
  for (const std::string_view prefix : {"book:", "nbrdf:", "np:", "surface:"})
    if (source.starts_with(prefix) && source.find('#') != std::string::npos)
      return export_name(std::string_view(source).substr(source.rfind('#') + 1));
  return export_name(std::filesystem::path(source).stem().string());
}

// Writes the files where a folder is given, and returns them by name.
nb::dict handed_out(const ExportedFiles& exported, const std::optional<std::filesystem::path>& folder) {
  if (folder) write_files(*folder, exported.files);
  nb::dict files;
  for (const auto& [name, bytes] : exported.files)
    files[name.c_str()] = nb::bytes(bytes.data(), bytes.size());
  return files;
}

nb::dict exported_model(const OpenedModel& model, const Names& to,
                        const std::optional<std::filesystem::path>& folder,
                        const std::optional<std::string>& name, bool exact, bool half, bool mips,
                        bool compressed, int cells, const std::optional<std::string>& environment,
                        std::optional<int> binding, std::optional<int> set, std::optional<int> space,
                        bool appended) {
  const ExportedFiles exported = [&] {
    const nb::gil_scoped_release unlocked;
    ExportOptions options{.to = targets_of(to),
                          .name = name ? *name : name_of(model.source().name),
                          .exact = exact,
                          .half = half,
                          .mips = mips,
                          .compressed = compressed,
                          .cells = cells,
                          .places = {binding, set, space},
                          .appended = appended,
                          .notes = model.source().findings.notes};
    if (environment) options.environment = open_environment(*environment);
    return export_model(model.brdf(), options);
  }();
  return handed_out(exported, folder);
}

nb::dict exported_analytic(const std::string& spec, const Names& to,
                           const std::optional<std::filesystem::path>& folder,
                           const std::optional<std::string>& name, int cells,
                           const std::optional<std::string>& power) {
  const Source source = open_source(spec, {});
  const auto* const brdf = std::get_if<AnalyticBrdf>(&source.brdf);
  if (!brdf)
    throw Error(spec +
                ": expected an analytic BRDF, found another BRDF; make a Model of it by open_source or fit");
  const ExportOptions options{.to = targets_of(to), .name = name ? *name : name_of(spec), .cells = cells};
  if (!power && brdf->model().name == "openpbr") return handed_out(export_openpbr(*brdf, options), folder);
  const std::optional<PowerMethod> method = power ? std::optional(power_method(*power)) : std::nullopt;
  return handed_out(export_specular(format_analytic(*brdf), method, options), folder);
}

}  // namespace

void bind_exports(nb::module_& m) {
  const ExportOptions defaults;
  m.def(
      "export", &exported_model, nb::arg("model"), nb::arg("to"), nb::arg("folder") = nb::none(),
      nb::kw_only(), nb::arg("name") = nb::none(), nb::arg("exact") = defaults.exact,
      nb::arg("half") = defaults.half, nb::arg("mips") = defaults.mips,
      nb::arg("compressed") = defaults.compressed, nb::arg("cells") = defaults.cells,
      nb::arg("environment") = nb::none(), nb::arg("binding") = nb::none(), nb::arg("set") = nb::none(),
      nb::arg("space") = nb::none(), nb::arg("appended") = defaults.appended,
      nb::sig("def export(model: Model, to: str | list[str], folder: str | os.PathLike | None = None, *, "
              "name: str | None = None, exact: bool = False, half: bool = False, mips: bool = False, "
              "compressed: bool = True, cells: int = 90, environment: str | None = None, "
              "binding: int | None = None, set: int | None = None, space: int | None = None, "
              "appended: bool = False) -> dict[str, bytes]"),
      fmt::format(
          "Returns the files that `burnish export` writes, as bytes by file name. The last one is the\n"
          "manifest NAME.json. The files are also written into the folder if there is one.\n"
          "\n"
          "to: one or several of {}. Shaders come with their textures.\n"
          "name: the name of files, functions and MaterialX nodes. By default it is the source's: \"paint\" "
          "for\n"
          "\"paint.binary\".\n"
          "exact: shaders interpolate texels themselves, in floats.\n"
          "half: shaders multiply texels in half precision (mediump, min16float, half, f16), within 1 %;\n"
          "\"cpp\" stays in single precision.\n"
          "mips: KTX2 files have mip levels.\n"
          "compressed: KTX2 files are compressed by Zstandard.\n"
          "cells: the cells of \"mdl\" along each polar angle.\n"
          "environment: \"sun\", \"studio\" or an OpenEXR picture of all directions. It lights exports to "
          "{}.\n"
          "binding, set, space: the numbers of textures in shaders, as `burnish export --binding`, `--set`\n"
          "and `--space` take them.\n"
          "appended: shaders can be appended to other shaders in one file.",
          quoted_names(export_target_names()), targets_that(shows_environment))
          .c_str());
  m.def("export", &exported_analytic, nb::arg("spec"), nb::arg("to"), nb::arg("folder") = nb::none(),
        nb::kw_only(), nb::arg("name") = nb::none(), nb::arg("cells") = defaults.cells,
        nb::arg("power") = nb::none(),
        nb::sig("def export(spec: str, to: str | list[str], folder: str | os.PathLike | None = None, *, "
                "name: str | None = None, cells: int = 90, power: str | None = None) -> dict[str, bytes]"),
        "Exports an analytic BRDF.\n"
        "OpenPBR, such as \"openpbr:coat_weight=1\" or a file of it, becomes shaders or \"three\", "
        "\"babylon\",\n"
        "\"materialx\", \"usda\", \"mdl\", \"gltf\", \"rgl\" or \"html\".\n"
        "Phong's or Blinn's model, such as \"blinn_phong:exponent=60\", becomes shaders or \"html\".\n"
        "\n"
        "cells: the cells of \"mdl\" along each polar angle.\n"
        "power: the method that computes the specular power, a member of the specular family. The default\n"
        "is the cheapest method that is never one of 255 levels off.");
}

}  // namespace burnish::python
