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
    throw Error(spec + ": expected an analytic BRDF, found another; open_source or fit make a Model of it");
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
          "What `burnish export` writes, by the files' names, the last one the manifest NAME.json; into the "
          "folder\n"
          "too where one is given.\n\n"
          "to: one or several of {}.\nShaders bring their textures along. "
          "name: of files,\nfunctions and MaterialX's nodes; by default the source's, \"paint\" for "
          "\"paint.binary\". exact: shaders weigh texels themselves, in floats. half: they multiply "
          "them in half precision\n(mediump, min16float, half, f16), within 1 %; \"cpp\" stays single. mips: "
          "KTX2 "
          "with levels. "
          "compressed: KTX2\nwith Zstandard. cells: of \"mdl\", along each polar angle. environment: "
          "\"sun\", "
          "\"studio\" or an OpenEXR picture of all "
          "directions, "
          "whose light {}\nshow. binding, set, space: numbers of textures in shaders, as `burnish export "
          "--binding`, `--set` and\n`--space` have them. appended: shaders go behind others in one file.",
          quoted_names(export_target_names()), targets_that(shows_environment))
          .c_str());
  m.def("export", &exported_analytic, nb::arg("spec"), nb::arg("to"), nb::arg("folder") = nb::none(),
        nb::kw_only(), nb::arg("name") = nb::none(), nb::arg("cells") = defaults.cells,
        nb::arg("power") = nb::none(),
        nb::sig("def export(spec: str, to: str | list[str], folder: str | os.PathLike | None = None, *, "
                "name: str | None = None, cells: int = 90, power: str | None = None) -> dict[str, bytes]"),
        "OpenPBR, such as \"openpbr:coat_weight=1\" or a file of it, as shaders or \"three\", \"babylon\", "
        "\"materialx\",\n\"usda\", \"mdl\", \"gltf\", \"rgl\" or \"html\". cells: of \"mdl\", along each "
        "polar angle.\n"
        "Phong's or Blinn's model, such as \"blinn_phong:exponent=60\", as shaders or \"html\". power: how "
        "it is\n"
        "computed, a member of the specular family; by default the cheapest that is never one of 255 levels "
        "off.");
}

}  // namespace burnish::python
