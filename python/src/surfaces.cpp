// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <type_traits>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <burnish/capture/surface_fit.h>
#include <burnish/error.h>
#include <burnish/eval/spatial_eval.h>
#include <burnish/export/export_surface.h>
#include <burnish/file.h>
#include <burnish/math/parallel.h>
#include <burnish/surface/surface_file.h>

#include "array_like.h"
#include "opened_brdf.h"
#include "progress.h"
#include "rows.h"
#include "texts.h"

namespace burnish::python {

namespace {

/// burnish.Surface: a surface and its evaluator.
struct OpenedSurface {
  SpatialEvaluator evaluator;
  std::string notes, name;

  OpenedSurface(const std::string& called, SurfaceModel model)
      : evaluator(std::move(model.brdf)), notes(std::move(model.notes)), name(called) {}
  const SpatialBrdf& brdf() const noexcept { return evaluator.surface(); }
};

// Returns a capture's name: that of its file without the ending, or that of its folder.
std::string called(const std::filesystem::path& capture) {
  const std::filesystem::path path = capture.has_filename() ? capture : capture.parent_path();
  return std::filesystem::is_directory(path) ? path.filename().string() : path.stem().string();
}

OpenedSurface* open_surface(const std::filesystem::path& path) {
  return new OpenedSurface(path.stem().string(), parse_surface(read_file(path)));
}

// A task has so many pairs.
constexpr std::size_t kSurfaceChunk = 4096;

// These evaluate a place: one in floats, one by the definition. Directions are in the surface's frame.
struct FastPlace {
  const SpatialEvaluator& evaluator;
  SpatialEvaluator::Place place;

  FastPlace(const OpenedSurface& surface, double u, double v, double lod)
      : evaluator(surface.evaluator), place(evaluator.place(u, v, lod)) {}
  void eval(Vec3 wi, Vec3 wo, std::span<float> f) const noexcept { evaluator.eval(place, wi, wo, f); }
};
struct DefinedPlace {
  const SpatialBrdf& brdf;
  SpatialBrdf::Place place;

  DefinedPlace(const OpenedSurface& surface, double u, double v, double lod)
      : brdf(surface.brdf()), place(brdf.place(u, v, lod)) {}
  void eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
    brdf.eval(place, place.frame.local(wi), place.frame.local(wo), f);
  }
};

template <class T>
nb::object eval(const OpenedSurface& surface, const Array<const T>& uv_array, const Array<const T>& wi_array,
                const Array<const T>& wo_array, double lod, const nb::object& out) {
  using Place = std::conditional_t<std::is_same_v<T, float>, FastPlace, DefinedPlace>;
  Rows<const T> uv = rows_of<T>(uv_array, "uv", 2), wi = rows_of<T>(wi_array, "wi", 3),
                wo = rows_of<T>(wo_array, "wo", 3);
  const bool one = uv.one && wi.one && wo.one, one_place = uv.count == 1;
  const std::size_t count = match(uv, wi, wo, "uv, wi and wo"), channels = surface.brdf().channels();
  const bool planes = wi.planes() && wo.planes() && count > 1;
  const Result<T> result = make_result<T>(out, count, channels, planes);
  const auto is_place = [&](std::size_t i) {
    return std::isfinite(*uv.at(i, 0)) && std::isfinite(*uv.at(i, 1));
  };
  const auto place_of = [&](std::size_t i) {
    return Place(surface, static_cast<double>(*uv.at(i, 0)), static_cast<double>(*uv.at(i, 1)), lod);
  };
  {
    const nb::gil_scoped_release released;
    std::optional<Place> only;
    if (one_place && is_place(0)) only.emplace(place_of(0));
    for_each_chunk(count, kSurfaceChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::array<T, kMaxMapChannels> values;
      const auto f = std::span(values).first(channels);
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 to_light = vector_at(wi, i), to_viewer = vector_at(wo, i);
        if (!is_place(i) || !is_direction(to_light) || !is_direction(to_viewer))
          std::ranges::fill(f, std::numeric_limits<T>::quiet_NaN());
        else if (only)
          only->eval(to_light, to_viewer, f);
        else
          place_of(i).eval(to_light, to_viewer, f);
        for (std::size_t c = 0; c < channels; ++c) *result.rows.at(i, c) = f[c];
      }
    });
  }
  return one && out.is_none() ? nb::object(result.array[0]) : result.array;
}

nb::object eval_any(const OpenedSurface& surface, nb::handle uv, nb::handle wi, nb::handle wo, double lod,
                    const nb::object& out) {
  return is_single({uv, wi, wo}, out)
             ? eval<float>(surface, array_of<float>(uv, "uv"), array_of<float>(wi, "wi"),
                           array_of<float>(wo, "wo"), lod, out)
             : eval<double>(surface, array_of<double>(uv, "uv"), array_of<double>(wi, "wi"),
                            array_of<double>(wo, "wo"), lod, out);
}

constexpr const char* kSurfaceEvalDoc =
    "Returns f_r in 1/sr, without the cosine, at places of the surface.\n"
    "\n"
    "uv: the places, (N, 2) or (2,), v downwards.\n"
    "wi, wo: unit vectors of the surface's frame, (N, 3) or (3,). All three arguments are float32 or\n"
    "all float64. Any strides are read in place. Lists are taken as Source.eval takes them. A single\n"
    "row stands for every row of the other arguments. The texels of a single place are looked up once.\n"
    "lod: the mip level, which may lie between two levels.\n"
    "Returns (N, channels) of the same type, or fills and returns `out`. float64 is evaluated by the\n"
    "definition, float32 by the fast evaluator. The value is nan where uv is not finite, and where wi\n"
    "or wo is not a unit vector to 1 %.";

nb::object values_of(const SurfaceMap& map) {
  std::vector<float> values;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const SurfaceMap::Value value = map.texel(x, y);
      values.insert(values.end(), value.begin(), value.begin() + static_cast<std::ptrdiff_t>(map.channels()));
    }
  return to_numpy(std::move(values), {static_cast<std::size_t>(map.height()),
                                      static_cast<std::size_t>(map.width()), map.channels()});
}

nb::list weights_of(const OpenedSurface& surface) {
  nb::list weights;
  for (const SurfaceMap& map : surface.brdf().maps().weights) weights.append(values_of(map));
  return weights;
}

nb::object map_or_none(const std::optional<SurfaceMap>& map) {
  return map ? values_of(*map) : nb::none();
}

nb::dict albedo_of(const OpenedSurface& surface) {
  const SurfaceAlbedo albedo = [&] {
    const nb::gil_scoped_release released;
    return surface_albedo(surface.brdf());
  }();
  nb::dict found;
  found["mean"] = albedo.mean;
  found["largest"] = albedo.largest;
  found["texel"] = nb::make_tuple(albedo.x, albedo.y);
  found["theta_i"] = albedo.theta_i;
  found["texels_above_one"] = albedo.above_one;
  return found;
}

NormalsFrom normals_from(const std::string& name) {
  if (name == "capture") return NormalsFrom::capture;
  if (name == "flat") return NormalsFrom::flat;
  if (name == "estimate") return NormalsFrom::estimate;
  throw Error("normals: expected capture, flat or estimate, found '" + name + "'");
}

nb::tuple fit_surface(const std::filesystem::path& capture, std::size_t lobes, std::size_t lobe_bytes,
                      const OpenedModel* book, const std::optional<std::string>& normals,
                      std::optional<int> rounds, bool widened, std::uint64_t seed,
                      const std::optional<std::filesystem::path>& checkpoint, std::size_t pictures,
                      std::size_t memory, const nb::object& progress) {
  SurfaceFitOptions options;
  options.lobes = lobes;
  options.lobe_bytes = lobe_bytes;
  options.rounds = rounds;
  options.widened = widened;
  options.seed = seed;
  options.tile_bytes = memory;
  options.progress = progress_of(progress);
  if (book) options.book = book->brdf();
  if (normals) options.normals = normals_from(*normals);
  if (checkpoint) options.checkpoint = *checkpoint;
  SurfaceFit fit = [&] {
    const nb::gil_scoped_release released;
    return burnish::fit_surface(Capture(capture, pictures), options);
  }();
  if (std::error_code ignored; checkpoint) std::filesystem::remove(*checkpoint, ignored);
  nb::object report = from_json(report_json(fit.report));
  return nb::make_tuple(
      nb::cast(new OpenedSurface(called(capture), std::move(fit.surface)), nb::rv_policy::take_ownership),
      report);
}

nb::dict exported(const OpenedSurface& surface, const std::vector<std::string>& to,
                  const std::optional<std::filesystem::path>& folder, const std::optional<std::string>& name,
                  bool exact, bool blocks) {
  ExportOptions options{
      .to = {}, .name = name ? *name : export_name(surface.name), .exact = exact, .blocks = blocks};
  for (const std::string& target : to) options.to.push_back(export_target(target));
  const ExportedFiles files = [&] {
    const nb::gil_scoped_release released;
    return export_surface(surface.brdf(), options);
  }();
  if (folder) write_files(*folder, files.files);
  nb::dict by_name;
  for (const auto& [file, bytes] : files.files) by_name[file.c_str()] = nb::bytes(bytes.data(), bytes.size());
  return by_name;
}

}  // namespace

void bind_surfaces(nb::module_& m) {
  nb::class_<OpenedSurface>(
      m, "Surface",
      "A factored BRDF whose lobes' scales are maps. It never changes, so threads may share it.")
      .def_prop_ro("width", [](const OpenedSurface& s) { return s.brdf().width(); })
      .def_prop_ro("height", [](const OpenedSurface& s) { return s.brdf().height(); })
      .def_prop_ro("channels", [](const OpenedSurface& s) { return s.brdf().channels(); })
      .def_prop_ro("bytes", [](const OpenedSurface& s) { return s.brdf().bytes(); })
      .def_prop_ro(
          "lobes",
          [](const OpenedSurface& s) {
            return new OpenedModel("lobes", {s.brdf().lobes(), {}, "{}"});
          },
          nb::rv_policy::take_ownership, "The Model of the surface's lobes, each with weight 1.")
      .def_prop_ro("weights", &weights_of,
                   "One float32 array (height, width, 1 or channels) for each lobe; row 0 is at v = 0.")
      .def_prop_ro(
          "normals", [](const OpenedSurface& s) { return map_or_none(s.brdf().maps().normals); },
          "x and y of the normals, (height, width, 2), or None where all are (0, 0).")
      .def_prop_ro(
          "tangents", [](const OpenedSurface& s) { return map_or_none(s.brdf().maps().tangents); },
          "x and y of tangents in the plane, (height, width, 2), or None where all are (1, 0).")
      .def_prop_ro(
          "notes", [](const OpenedSurface& s) { return from_json(s.notes); }, "Notes of the fit.")
      .def("__repr__",
           [](const OpenedSurface& s) {
             const SpatialBrdf& brdf = s.brdf();
             return fmt::format("<burnish surface '{}': {} x {} texels, {}, {}, {}>", s.name, brdf.width(),
                                brdf.height(), counted(brdf.lobes().lobes().size(), "lobe"),
                                counted(brdf.channels(), "channel"), counted(brdf.bytes(), "byte"));
           })
      .def("eval", &eval<float>, nb::arg("uv").noconvert(), nb::arg("wi").noconvert(),
           nb::arg("wo").noconvert(), nb::arg("lod") = 0.0, nb::arg("out") = nb::none(),
           nb::sig("def eval(self, uv: NDArray[numpy.float32], wi: NDArray[numpy.float32], wo: "
                   "NDArray[numpy.float32], lod: float = 0.0, out: NDArray[numpy.float32] | None = None) -> "
                   "NDArray[numpy.float32]"),
           kSurfaceEvalDoc)
      .def("eval", &eval<double>, nb::arg("uv").noconvert(), nb::arg("wi").noconvert(),
           nb::arg("wo").noconvert(), nb::arg("lod") = 0.0, nb::arg("out") = nb::none(),
           nb::sig("def eval(self, uv: NDArray[numpy.float64], wi: NDArray[numpy.float64], wo: "
                   "NDArray[numpy.float64], lod: float = 0.0, out: NDArray[numpy.float64] | None = None) -> "
                   "NDArray[numpy.float64]"))
      .def("eval", &eval_any, nb::arg("uv").none(), nb::arg("wi").none(), nb::arg("wo").none(),
           nb::arg("lod") = 0.0, nb::arg("out") = nb::none(),
           nb::sig("def eval(self, uv: numpy.typing.ArrayLike, wi: numpy.typing.ArrayLike, "
                   "wo: numpy.typing.ArrayLike, lod: float = 0.0, out: NDArray | None = None) -> NDArray"))
      .def(
          "at",
          [](const OpenedSurface& s, double u, double v, double lod) {
            if (!std::isfinite(u) || !std::isfinite(v))
              throw Error(fmt::format("at: expected finite u and v, found {} and {}", u, v));
            return new OpenedModel("place", {s.brdf().at(u, v, lod), {}, "{}"});
          },
          nb::arg("u"), nb::arg("v"), nb::arg("lod") = 0.0, nb::rv_policy::take_ownership,
          "Returns the Model of a place, in the frame of that place.")
      .def("albedo", &albedo_of,
           "Returns the mean and largest share of light that texels reflect, and the texel of the largest\n"
           "share.")
      .def("export", &exported, nb::arg("to"), nb::arg("folder") = nb::none(), nb::arg("name") = nb::none(),
           nb::arg("exact") = false, nb::arg("blocks") = false,
           "Returns files by name, as `burnish export` writes them: shaders, ktx2, exr, png, gltf, three,\n"
           "html.\n"
           "\n"
           "name: the name of files and functions, by default the surface's.\n"
           "blocks: stores maps as pairs in BC5.")
      .def(
          "write",
          [](const OpenedSurface& s, const std::filesystem::path& path) {
            write_then_rename(path, format_surface_as(path, {s.brdf(), s.notes}));
          },
          nb::arg("path"),
          "Writes the file of the surface: OpenEXR where the name ends in .exr, else .burnish.");
  m.def("open_surface", &open_surface, nb::arg("path"), nb::rv_policy::take_ownership,
        "Reads the .burnish or OpenEXR file of a surface.");
  m.def("fit_surface", &fit_surface, nb::arg("capture"), nb::kw_only(), nb::arg("lobes") = 6,
        nb::arg("lobe_bytes") = 24 << 10, nb::arg("book").none() = nb::none(),
        nb::arg("normals") = nb::none(), nb::arg("rounds").none() = nb::none(), nb::arg("widened") = false,
        nb::arg("seed") = 1, nb::arg("checkpoint") = nb::none(), nb::arg("pictures") = Capture::kBtfPictures,
        nb::arg("memory") = SurfaceFitOptions().tile_bytes, nb::arg("progress") = nb::none(),
        "Fits a surface as `burnish fit-surface` does, and returns (Surface, report).\n"
        "\n"
        "capture: the folder of a capture, a BTF, or a CSV file with samples of texels.\n"
        "pictures: how many pictures of a BTF are taken.\n"
        "memory: the most bytes of pictures that are in memory at a time.\n"
        "progress(stage, fraction) is called from this thread. An exception that it raises ends the fit,\n"
        "and so does Ctrl-C.\n"
        "checkpoint: a file that lets a stopped fit resume. It is removed at the end of the fit.");
}

}  // namespace burnish::python
