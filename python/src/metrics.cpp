// SPDX-License-Identifier: Apache-2.0
#include <list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/metrics/albedo.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/report/compare_report.h>

#include "array_like.h"
#include "opened_brdf.h"
#include "rows.h"

namespace burnish::python {

namespace {

ErrorFigures error_figures(const OpenedBrdf& reference, const OpenedBrdf& model, std::size_t count,
                           std::uint64_t seed, double floor, int image_size, bool symmetrize) {
  return without_gil(FunctionWatch({&reference, &model}), [&] {
    const Reciprocal a(reference, symmetrize), b(model, symmetrize);
    return burnish::error_figures(a.ref(), b.ref(),
                                  {.count = count, .seed = seed, .floor = floor, .image_size = image_size});
  });
}

std::string text_of(const ErrorFigures& figures) {
  return fmt::format(
      "ErrorFigures(psnr={:.2f}, ssim={:.4f}, relative={:.4g}, rms_log={:.4g}, log_cos={:.4g}, "
      "mean_abs_log={:.4g}, "
      "unknown_fraction={:.3g})",
      figures.psnr, figures.ssim, figures.relative, figures.rms_log, figures.log_cos, figures.mean_abs_log,
      figures.unknown_fraction);
}

using Named = std::vector<std::pair<std::string, const OpenedBrdf*>>;

// Names the rows: each by its model's name. A name that is taken, by the reference or another model, becomes the
// description and the bytes.
Named with_names(const OpenedBrdf& reference, const std::vector<const OpenedBrdf*>& models) {
  std::map<std::string, int> taken{{reference.source().name, 1}};
  for (const OpenedBrdf* model : models) ++taken[model->source().name];
  Named named;
  std::map<std::string, int> given;
  for (const OpenedBrdf* model : models) {
    const Source& source = model->source();
    std::string name = source.name;
    if (taken[name] > 1 && source.bytes() && !source.findings.description.empty())
      name = fmt::format("{}, {} bytes", source.findings.description, *source.bytes());
    if (const int before = given[name]++; before > 0) name += fmt::format(" ({})", before + 1);
    named.emplace_back(std::move(name), model);
  }
  return named;
}

// Names the models. The keys of a dictionary are the names.
Named named_models(const OpenedBrdf& reference, const nb::object& models) {
  const auto opened = [](nb::handle model) {
    const OpenedBrdf* found = nullptr;
    if (!nb::try_cast(model, found, false) || !found)
      throw nb::type_error(fmt::format("models: expected a Source, a list or a dictionary of them, found {}",
                                       nb::repr(model).c_str())
                               .c_str());
    return found;
  };
  if (nb::isinstance<nb::dict>(models)) {
    Named named;
    for (const auto& [name, model] : nb::cast<nb::dict>(models))
      named.emplace_back(nb::str(name).c_str(), opened(model));
    return named;
  }
  std::vector<const OpenedBrdf*> list;
  if (!nb::isinstance<nb::list>(models) && !nb::isinstance<nb::tuple>(models))
    list.push_back(opened(models));
  else
    for (const nb::handle model : models) list.push_back(opened(model));
  return with_names(reference, list);
}

nb::object compare_models(const OpenedBrdf& reference, const nb::object& models, std::size_t count,
                          std::uint64_t seed, bool symmetrize,
                          const std::optional<std::filesystem::path>& report) {
  const Named named = named_models(reference, models);
  FunctionWatch watch({&reference});
  for (const auto& [name, model] : named) watch.add(*model);
  const std::string json = without_gil(watch, [&] {
    const Reciprocal made_reciprocal(reference, symmetrize);
    std::list<Reciprocal> candidates;
    std::vector<ComparedModel> compared;
    for (const auto& [name, model] : named) {
      const Source& source = model->source();
      compared.push_back({.name = name,
                          .brdf = candidates.emplace_back(*model, symmetrize).ref(),
                          .bytes = source.bytes(),
                          .note = source.findings.description,
                          .factored = model->model()});
    }
    const Scorer scorer(made_reciprocal.ref(), {.count = count, .seed = seed});
    const Source& source = reference.source();
    std::optional<Measurement> measurement = measurement_of(source, made_reciprocal.ref());
    const Measurement* const measured = measurement ? &*measurement : nullptr;
    if (!report) return to_json(burnish::compare_models(scorer, compared, measured), measured);
    // Exchanged directions of a transmission have the light on the other side, so they say nothing about the error.
    if (measurement && !source.findings.transmits())
      measurement->quality = quality_by_exchange(scorer, source.ref(), measurement->nodes);
    return to_json(write_report(*report, source.name, scorer, compared, measured), measured);
  });
  return from_json(json);
}

nb::object directional_albedo(const OpenedBrdf& source, nb::handle directions) {
  const auto wi = array_of<double>(directions, "wi");
  const Rows<const double> rows = rows_of<double>(wi, "wi", 3);
  const std::size_t channels = source.ref().channels();
  std::vector<double> albedo;
  without_gil(FunctionWatch({&source}), [&] {
    for (std::size_t i = 0; i < rows.count; ++i) {
      const Vec3 w{*rows.at(i, 0), *rows.at(i, 1), *rows.at(i, 2)};
      if (!(w.z > 0 && std::abs(dot(w, w) - 1) < 0.02))
        throw Error(
            fmt::format("wi: expected unit vectors above the horizon, found ({}, {}, {})", w.x, w.y, w.z));
      const DirectionalAlbedo at = burnish::directional_albedo(source.ref(), w);
      albedo.insert(albedo.end(), at.albedo.begin(), at.albedo.end());
    }
  });
  const nb::object array = to_numpy(std::move(albedo), {rows.count, channels});
  return rows.one ? nb::object(array[0]) : array;
}

template <class T>
nb::object to_numpy_image(BasicImage<T> image) {
  return to_numpy(std::move(image.pixels), {static_cast<std::size_t>(image.height),
                                            static_cast<std::size_t>(image.width), image.channels});
}

nb::tuple pair_arrays(const std::vector<DirectionPair>& pairs) {
  std::vector<double> wi, wo;
  for (const auto& [i, o] : pairs) {
    wi.insert(wi.end(), {i.x, i.y, i.z});
    wo.insert(wo.end(), {o.x, o.y, o.z});
  }
  return nb::make_tuple(to_numpy(std::move(wi), {pairs.size(), 3}),
                        to_numpy(std::move(wo), {pairs.size(), 3}));
}

void bind_error_figures(nb::module_& m) {
  nb::class_<ErrorFigures>(m, "ErrorFigures", "The errors of a model against a reference.")
      .def_ro("log_cos", &ErrorFigures::log_cos, "mean |ln(1 + f cos theta_i) - ln(1 + f^ cos theta_i)|")
      .def_ro("relative", &ErrorFigures::relative, "exp(mean |ln((f + floor) / (f^ + floor))|) - 1")
      .def_ro("rms_log", &ErrorFigures::rms_log, "root mean square of ln((f + floor) / (f^ + floor))")
      .def_ro("mean_abs_log", &ErrorFigures::mean_abs_log, "mean |ln(f / f^)| where both are above 0")
      .def_ro("psnr", &ErrorFigures::psnr, "PSNR of the lit spheres in dB; infinite if they are equal")
      .def_ro("ssim", &ErrorFigures::ssim, "mean SSIM of the lit spheres")
      .def_ro("unknown_fraction", &ErrorFigures::unknown_fraction,
              "share of the pairs that have no known value")
      .def_ro("unknown_pixels", &ErrorFigures::unknown_pixels)
      .def("__repr__", &text_of);
  m.def("error_figures", &error_figures, nb::arg("reference"), nb::arg("model"), nb::kw_only(),
        nb::arg("count") = FigureOptions{}.count, nb::arg("seed") = FigureOptions{}.seed,
        nb::arg("floor") = FigureOptions{}.floor, nb::arg("image_size") = FigureOptions{}.image_size,
        nb::arg("symmetrize") = true,
        "Returns the error figures of a model, from `count` direction pairs and lit spheres of `image_size`\n"
        "pixels.\n"
        "\n"
        "floor: in 1/sr, added to values before their logarithms are taken.\n"
        "symmetrize: compares the reciprocal parts of both BRDFs, as burnish does everywhere.");
  m.def("compare_models", &compare_models, nb::arg("reference"), nb::arg("models"), nb::kw_only(),
        nb::arg("count") = FigureOptions{}.count, nb::arg("seed") = FigureOptions{}.seed,
        nb::arg("symmetrize") = true, nb::arg("report") = nb::none(),
        nb::sig("def compare_models(reference: Source, models: Sequence[Source] | Mapping[str, Source], *, "
                "count: int = 200000, seed: int = 1, symmetrize: bool = True, report: str | os.PathLike | "
                "None = None) "
                "-> list[dict]"),
        "Returns what `burnish compare --json` prints, one dictionary for each model. A measurement adds\n"
        "the errors at its nodes, and scattered samples add the expected error.\n"
        "\n"
        "models: a dictionary names them by its keys, {\"small\": model}. In a list each model has the name\n"
        "of its source. A name that the reference or another model also has is replaced by the model's\n"
        "expression and bytes.\n"
        "report: a folder for pictures and plots.");
}

}  // namespace

void bind_metrics(nb::module_& m) {
  bind_error_figures(m);
  m.def(
      "directional_albedo", &directional_albedo, nb::arg("source"), nb::arg("wi"),
      nb::sig("def directional_albedo(source: Source, wi: numpy.typing.ArrayLike) -> NDArray[numpy.float64]"),
      "Returns the share of light from wi that is reflected, for each channel, to 0.5 %.\n"
      "\n"
      "wi: unit vectors above the horizon, (N, 3) or (3,). Returns (N, channels) or (channels,).");
  m.def(
      "render_sphere",
      [](const OpenedBrdf& source, double light_angle, int size) {
        Image image = without_gil(FunctionWatch({&source}),
                                  [&] { return render_sphere(source.ref(), light_angle, size).image; });
        return to_numpy_image(std::move(image));
      },
      nb::arg("source"), nb::arg("light_angle"), nb::arg("size") = kSphereSize,
      nb::sig(
          "def render_sphere(source: Source, light_angle: float, size: int = 256) -> NDArray[numpy.float32]"),
      "Renders a sphere under a directional light that stands light_angle radians from the view. The view\n"
      "is orthographic, along the normal of the sphere's middle.\n"
      "\n"
      "Returns f_r cos(theta_i) in 1/sr, linear, (size, size, channels), 0 outside the sphere.");
  m.def(
      "draw_pairs",
      [](std::size_t count, std::uint64_t seed, bool isotropic) {
        return pair_arrays(draw_pairs(count, seed, isotropic));
      },
      nb::arg("count"), nb::arg("seed") = 1, nb::arg("isotropic") = true,
      nb::sig("def draw_pairs(count: int, seed: int = 1, isotropic: bool = True) -> "
              "tuple[NDArray[numpy.float64], NDArray[numpy.float64]]"),
      "Draws the direction pairs at which error figures are computed: wi and wo, float64 (count, 3).\n"
      "\n"
      "Pairs are uniform in theta_h, theta_d and phi_d, and in phi_h unless isotropic. Both cosines are\n"
      "above 0.05.");
  m.def(
      "measure",
      [](const OpenedBrdf& source, std::size_t count, double noise, std::uint64_t seed) {
        Samples samples = without_gil(FunctionWatch({&source}), [&] {
          return measure(source.ref(), {count, noise, seed});
        });
        const nb::tuple pairs = pair_arrays(samples.pairs);
        return nb::make_tuple(pairs[0], pairs[1],
                              to_numpy(std::move(samples.values), {samples.size(), samples.channels}));
      },
      nb::arg("source"), nb::kw_only(), nb::arg("count") = MeasureOptions{}.count, nb::arg("noise") = 0.0,
      nb::arg("seed") = 1,
      nb::sig("def measure(source: Source, *, count: int = 10000, noise: float = 0.0, seed: int = 1) -> "
              "tuple[NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64]]"),
      "Measures a source by a virtual goniometer. Returns wi and wo (count, 3), and values (count,\n"
      "channels) in 1/sr.\n"
      "\n"
      "noise: the standard deviation of the logarithm of a random factor on each value.");
}

}  // namespace burnish::python
