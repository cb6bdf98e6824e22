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

// Nothing for "auto".
std::optional<std::uint64_t> bytes_of(const std::variant<std::uint64_t, std::string>& budget) {
  if (const auto* number = std::get_if<std::uint64_t>(&budget)) return *number;
  if (const auto& word = std::get<std::string>(budget); word != "auto")
    throw Error("budget: expected \"auto\" or a number of bytes, found '" + word + "'");
  return {};
}

OpenedModel* fit(const OpenedBrdf& source, const std::string& model, const std::vector<std::string>& tables,
                 const std::variant<std::uint64_t, std::string>& budget, int fetches, int lobes, bool search,
                 const std::string& loss, const std::variant<std::monostate, double, std::string>& smooth,
                 std::optional<int> reweightings, double floor, const std::optional<std::string>& format,
                 std::size_t samples, std::uint64_t seed, bool symmetrize, bool conserve_energy,
                 const std::shared_ptr<const MaterialBook>& book, const std::optional<std::string>& target,
                 const std::optional<std::string>& hold_out, const nb::object& progress) {
  FitOptions options = fit_options(
      {model, tables, budget, fetches, lobes, search, loss, smooth, reweightings, floor, format, samples,
       seed, symmetrize, conserve_energy, book, "", target.value_or(""), hold_out.value_or("")},
      source.source().ref().isotropic());
  options.progress = progress_of(progress);
  const nb::gil_scoped_release released;
  return new OpenedModel(source.source().name, to_model(burnish::fit(source.source(), options)));
}

OpenedBaseline* fit_baseline(const OpenedBrdf& source, const std::string& method, std::uint64_t budget,
                             std::size_t samples, std::uint64_t seed, bool symmetrize,
                             const nb::object& progress) {
  FitOptions options = fit_options(
      {.budget = budget, .samples = samples, .seed = seed, .symmetrize = symmetrize, .method = method},
      source.source().ref().isotropic());
  options.progress = progress_of(progress);
  const nb::gil_scoped_release released;
  return new OpenedBaseline(source.source().name, to_baseline(burnish::fit(source.source(), options)));
}

nb::object fit_to_material(const OpenedBrdf& source, const std::string& to,
                           const std::optional<std::filesystem::path>& path, bool beside,
                           const nb::object& progress) {
  std::string summary;
  {
    const nb::gil_scoped_release released;
    const MaterialFit fit =
        fit_material(source.source(), to, {.beside = beside, .progress = progress_of(progress)});
    if (path) write_then_rename(*path, format_material(fit));
    summary = summary_json(fit, path ? path->string() : std::string());
  }
  return from_json(summary);
}

}  // namespace

FitOptions fit_options(const FitKeywords& given, bool isotropic) {
  LogLinear how{.reweightings = given.reweightings, .floor = given.floor};
  FitOptions options{.samples = given.samples,
                     .seed = given.seed,
                     .symmetrize = given.symmetrize,
                     .conserve_energy = given.conserve_energy};
  if (const auto* number = std::get_if<double>(&given.smooth)) options.smooth = *number;
  if (const auto* word = std::get_if<std::string>(&given.smooth)) {
    if (*word != "auto")
      throw Error("smooth: expected None, \"auto\" or a number >= 0, found '" + *word + "'");
    how.cross_validate = true;
  }
  if (given.format) options.format = parse_table_format(*given.format);
  if (!given.target.empty()) options.target = parse_fit_target(given.target);
  if (!given.hold_out.empty()) options.hold_out = parse_node_part(given.hold_out);
  const std::optional<std::uint64_t> bytes = bytes_of(given.budget);
  if (!given.method.empty()) {
    if (!bytes) throw Error("budget: expected a number of bytes with a method, found 'auto'");
    if (!given.model.empty() || !given.tables.empty() || given.book || given.fetches || given.lobes ||
        given.search)
      throw Error("method: expected neither a model, tables and a book nor fetches, lobes and a search");
    options.form = BaselineMethod{.method = given.method, .bytes = *bytes};
  } else if (given.book)
    options.form = FromBook{given.book};
  else if (bytes != std::uint64_t{0})
    options.form = Budget{.bytes = bytes,
                          .fetches = given.fetches,
                          .lobes = given.lobes,
                          .search = given.search,
                          .loss = parse_fit_loss(given.loss),
                          .scattered = how};
  else
    options.form = form_of(given.model, given.tables, isotropic, how, parse_fit_loss(given.loss));
  return options;
}

void bind_fitting(nb::module_& m) {
  static const std::string kAboutMethods = fmt::format(
      "With a method, what others would fit instead of positive factors, as `burnish fit --method` "
      "does:\n{}.\n\n"
      "budget: bytes; samples, seed, symmetrize and progress as for a Model.",
      fmt::join(baseline_methods(), ", "));
  m.def("fit", &fit_baseline, nb::arg("source"), nb::kw_only(), nb::arg("method"), nb::arg("budget") = 0,
        nb::arg("samples") = 0, nb::arg("seed") = 1, nb::arg("symmetrize") = true,
        nb::arg("progress") = nb::none(), nb::rv_policy::take_ownership, kAboutMethods.c_str());
  m.def(
      "fit", &fit, nb::arg("source"), nb::kw_only(), nb::arg("model") = "",
      nb::arg("tables") = std::vector<std::string>(), nb::arg("budget") = 0, nb::arg("fetches") = 0,
      nb::arg("lobes") = 0, nb::arg("search") = false, nb::arg("loss") = "image",
      nb::arg("smooth") = nb::none(), nb::arg("reweightings") = nb::none(),
      nb::arg("floor") = LogLinear{}.floor, nb::arg("format") = nb::none(), nb::arg("samples") = 0,
      nb::arg("seed") = 1, nb::arg("symmetrize") = true, nb::arg("conserve_energy") = false,
      nb::arg("book") = nb::none(), nb::arg("target") = nb::none(), nb::arg("hold_out") = nb::none(),
      nb::arg("progress") = nb::none(), nb::rv_policy::take_ownership,
      "Fits a factored BRDF as `burnish fit` does: by default the model of some kilobytes and few fetches\n"
      "that serves most uses.\n\n"
      "model: product of tables over projections, \"pqp\", \"pqpr\" or such as\n"
      "\"p(wo) q(h) r(theta_d) p(wi)\", several lobes joined by +; tables: sizes such as \"q=96\" or\n"
      "\"p=16x16,identity\". budget: bytes, fits the best model that they hold instead; \"auto\": until "
      "more\n"
      "would store noise or hardly help\n"
      "(fetches: at most so many filtered reads of tables an evaluation, else at the knee; lobes: how many; "
      "search: look for "
      "factors\n"
      "and sizes first). loss: \"image\", \"relative\" or\n"
      "\"log_cos\", what several lobes are refined for. smooth: number >= 0, \"auto\" (cross-validation) or\n"
      "None. floor: 1/sr, added before logarithms are taken. format: \"half\", \"float\", \"rgb9e5\",\n"
      "\"unorm8\". samples: pairs drawn from a source that is a function. symmetrize: fit the reciprocal "
      "part.\n"
      "conserve_energy: damp the model where it reflects more than it receives. book: a Book, by which a "
      "few\n"
      "measured pairs are completed instead. target: \"function\", what the owner of a measurement makes of "
      "it,\n"
      "or \"nodes\", what was measured; None: of isotropic RGL files nodes, unless one lobe, "
      "smooth=\"auto\",\n"
      "symmetrize=False or a book is asked for, else the function.\n"
      "hold_out: nodes to leave out, \"half=0\", \"half=1\" or \"theta_i=K\".\n\n"
      "progress(stage, fraction) is called from this thread; what it raises ends the fit, and so does "
      "Ctrl-C.\n"
      "Model.notes says what was done and how far off the model is.");
  m.def("fit_material", &fit_to_material, nb::arg("source"), nb::arg("to"), nb::arg("path") = nb::none(),
        nb::kw_only(), nb::arg("beside") = true, nb::arg("progress") = nb::none(),
        nb::sig("def fit_material(source: Source, to: str, path: str | os.PathLike | None = None, *, beside: "
                "bool = True, progress: object | None = None) -> dict"),
        "Fits the parameters of a renderer's material, \"openpbr\" or \"gltf\", as `burnish fit --to` does, "
        "and "
        "returns\nwhat its --json prints: parameters, errors, what the BRDF does that the material cannot, "
        "and, "
        "beside, the\nerrors of a factored model. path: a file for the parameters. Of openpbr open_source "
        "takes "
        "the file and the\nsummary's \"spec\".");
  m.def(
      "conserve_energy",
      [](const OpenedModel& model) {
        const nb::gil_scoped_release released;
        Model kept = to_model(model);
        kept.brdf = conserve_energy(model.brdf()).brdf;
        return new OpenedModel(model.source().name, std::move(kept));
      },
      nb::arg("model"), nb::rv_policy::take_ownership,
      "The model damped where its directional albedo exceeds 1, reciprocal as it was.");
}

}  // namespace burnish::python
