// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/energy.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/fitting/parametric/material_fit.h>

#include "fit_keywords.h"
#include "opened_brdf.h"
#include "progress.h"

namespace burnish::python {

namespace {

constexpr std::string_view kOtherKeywords[] = {"progress"};

FitOptions options_for(const OpenedBrdf& source, const FitRequest& request, const nb::object& progress) {
  FitOptions options = fit_options(request, source.ref().isotropic());
  options.progress = [watch = FunctionWatch({&source}), progress = progress_of(progress)](
                         std::string_view stage, double fraction) {
    watch.rethrow();
    progress(stage, fraction);
  };
  return options;
}

OpenedModel* fit(const OpenedBrdf& source, const nb::object& progress, const nb::kwargs& how) {
  const FitOptions options = options_for(source, request_of("fit", how, kOtherKeywords), progress);
  return new OpenedModel(source.source().name, without_gil(FunctionWatch({&source}), [&] {
                           return to_model(burnish::fit(source.source(), options));
                         }));
}

OpenedBaseline* fit_baseline(const OpenedBrdf& source, const std::string& method, const nb::object& progress,
                             nb::kwargs how) {
  how["method"] = method;
  const FitOptions options = options_for(source, request_of("fit", how, kOtherKeywords), progress);
  return new OpenedBaseline(source.source().name, without_gil(FunctionWatch({&source}), [&] {
                              return to_baseline(burnish::fit(source.source(), options));
                            }));
}

nb::object fit_to_material(const OpenedBrdf& source, const std::string& to,
                           const std::optional<std::filesystem::path>& path, bool beside, bool simple,
                           const nb::object& progress) {
  return from_json(without_gil(FunctionWatch({&source}), [&] {
    const MaterialFit fit = fit_material(
        source.source(), to, {.beside = beside, .simple = simple, .progress = progress_of(progress)});
    if (path) write_then_rename(*path, format_material(fit));
    return summary_json(fit, path ? path->string() : std::string());
  }));
}

}  // namespace

void bind_fitting(nb::module_& m) {
  static const std::string kOfMethods = fit_signature(true), kOfModels = fit_signature(false);
  static const std::string kAboutMethods = fmt::format(
      "Fits another kind of model instead of positive factors, as `burnish fit --method` does. The\n"
      "methods are {}.\n"
      "\n"
      "{}progress: as for a Model.",
      fmt::join(baseline_methods(), ", "), fit_keyword_help(true));
  static const std::string kAboutModels =
      "Fits a factored BRDF as `burnish fit` does. Without options the model takes at most 16 KB and few\n"
      "fetches, which suits most uses.\n"
      "\n" +
      fit_keyword_help(false) +
      "\n"
      "progress(stage, fraction) is called from this thread. An exception that it raises ends the fit,\n"
      "and so does Ctrl-C.\n"
      "Model.notes has the options of the fit and the errors of the model.";
  m.def("fit", &fit_baseline, nb::arg("source"), nb::kw_only(), nb::arg("method"),
        nb::arg("progress") = nb::none(), nb::arg("how"), nb::rv_policy::take_ownership,
        nb::sig(kOfMethods.c_str()), kAboutMethods.c_str());
  m.def("fit", &fit, nb::arg("source"), nb::kw_only(), nb::arg("progress") = nb::none(), nb::arg("how"),
        nb::rv_policy::take_ownership, nb::sig(kOfModels.c_str()), kAboutModels.c_str());
  m.def("fit_material", &fit_to_material, nb::arg("source"), nb::arg("to"), nb::arg("path") = nb::none(),
        nb::kw_only(), nb::arg("beside") = true, nb::arg("simple") = false, nb::arg("progress") = nb::none(),
        nb::sig("def fit_material(source: Source, to: str, path: str | os.PathLike | None = None, *, beside: "
                "bool = True, simple: bool = False, progress: object | None = None) -> dict"),
        "Fits the parameters of a renderer's material, \"openpbr\" or \"gltf\", as `burnish fit --to` does.\n"
        "Returns what its --json prints: parameters, errors, and the effects of the BRDF that the material\n"
        "cannot show.\n"
        "\n"
        "path: a file for the parameters. open_source reads the file of openpbr, and the entry \"spec\" of\n"
        "the result.\n"
        "beside: adds the errors of a factored model.\n"
        "simple: fits OpenPBR with base and specular alone; the entry layered has the errors with coat,\n"
        "fuzz and film.");
  m.def(
      "conserve_energy",
      [](const OpenedModel& model) {
        const nb::gil_scoped_release released;
        Model kept = to_model(model);
        kept.brdf = conserve_energy(model.brdf()).brdf;
        return new OpenedModel(model.source().name, std::move(kept));
      },
      nb::arg("model"), nb::rv_policy::take_ownership,
      "Returns the model, damped where its directional albedo exceeds 1. A reciprocal model stays\n"
      "reciprocal.");
}

}  // namespace burnish::python
