#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
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

#include "opened_brdf.h"

namespace burnish::python {

namespace {

/// burnish.Surface: a surface and what evaluates it.
struct OpenedSurface {
  SpatialEvaluator evaluator;
  std::string notes;

  explicit OpenedSurface(SurfaceModel model)
      : evaluator(std::move(model.brdf)), notes(std::move(model.notes)) {}
  const SpatialBrdf& brdf() const noexcept { return evaluator.surface(); }
};

template <std::size_t columns>
using RowsOf =
    nb::ndarray<const float, nb::shape<-1, static_cast<nb::ssize_t>(columns)>, nb::c_contig, nb::device::cpu>;

OpenedSurface* open_surface(const std::string& path) {
  return new OpenedSurface(parse_surface(read_file(path)));
}

nb::object eval(const OpenedSurface& surface, const RowsOf<2>& uv, const RowsOf<3>& wi, const RowsOf<3>& wo,
                double lod) {
  const std::size_t count = wi.shape(0), channels = surface.brdf().channels();
  if (wo.shape(0) != count || (uv.shape(0) != count && uv.shape(0) != 1))
    throw Error(fmt::format("eval: expected as many rows in uv (or one), wi and wo, found {}, {} and {}",
                            uv.shape(0), count, wo.shape(0)));
  std::vector<float> values(count * channels);
  {
    const nb::gil_scoped_release released;
    constexpr std::size_t kChunk = 4096;
    for_each_chunk(count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      const auto vector = [](const float* w) {
        return Vec3{static_cast<double>(w[0]), static_cast<double>(w[1]), static_cast<double>(w[2])};
      };
      for (std::size_t i = begin; i < end; ++i) {
        const float* const at = uv.data() + (uv.shape(0) == 1 ? 0 : 2 * i);
        const SpatialEvaluator::Place place =
            surface.evaluator.place(static_cast<double>(at[0]), static_cast<double>(at[1]), lod);
        surface.evaluator.eval(place, vector(wi.data() + 3 * i), vector(wo.data() + 3 * i),
                               std::span(values).subspan(i * channels, channels));
      }
    });
  }
  return to_numpy(std::move(values), {count, channels});
}

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
                      const std::optional<std::filesystem::path>& checkpoint, std::size_t pictures) {
  SurfaceFitOptions options;
  options.lobes = lobes;
  options.lobe_bytes = lobe_bytes;
  options.rounds = rounds;
  options.widened = widened;
  options.seed = seed;
  if (book) options.book = book->brdf();
  if (normals) options.normals = normals_from(*normals);
  if (checkpoint) options.checkpoint = *checkpoint;
  SurfaceFit fit = [&] {
    const nb::gil_scoped_release released;
    return burnish::fit_surface(Capture(capture, pictures), options);
  }();
  if (std::error_code ignored; checkpoint) std::filesystem::remove(*checkpoint, ignored);
  nb::object report = from_json(report_json(fit.report));
  return nb::make_tuple(nb::cast(new OpenedSurface(std::move(fit.surface)), nb::rv_policy::take_ownership),
                        report);
}

nb::dict exported(const OpenedSurface& surface, const std::vector<std::string>& to,
                  const std::optional<std::filesystem::path>& folder, const std::string& name, bool exact) {
  ExportOptions options{.to = {}, .name = name, .exact = exact};
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
  nb::class_<OpenedSurface>(m, "Surface",
                            "A factored BRDF whose lobes' scales are maps. Immutable; threads may share it.")
      .def_prop_ro("width", [](const OpenedSurface& s) { return s.brdf().width(); })
      .def_prop_ro("height", [](const OpenedSurface& s) { return s.brdf().height(); })
      .def_prop_ro("channels", [](const OpenedSurface& s) { return s.brdf().channels(); })
      .def_prop_ro("bytes", [](const OpenedSurface& s) { return s.brdf().bytes(); })
      .def_prop_ro(
          "lobes",
          [](const OpenedSurface& s) {
            return new OpenedModel("lobes", {s.brdf().lobes(), {}, "{}"});
          },
          nb::rv_policy::take_ownership, "The Model of its lobes, each of weight 1.")
      .def_prop_ro("weights", &weights_of,
                   "One float32 (height, width, 1 or channels) a lobe, row 0 at v = 0.")
      .def_prop_ro(
          "normals", [](const OpenedSurface& s) { return map_or_none(s.brdf().maps().normals); },
          "x and y, (height, width, 2), or None: (0, 0).")
      .def_prop_ro(
          "tangents", [](const OpenedSurface& s) { return map_or_none(s.brdf().maps().tangents); },
          "x and y of a vector in the plane, or None: (1, 0).")
      .def_prop_ro(
          "notes", [](const OpenedSurface& s) { return from_json(s.notes); }, "What the fit wrote down.")
      .def(
          "eval", &eval, nb::arg("uv"), nb::arg("wi"), nb::arg("wo"), nb::arg("lod") = 0.0,
          "f_r in 1/sr, float32 (N, channels), at places uv, (N, 2) or (1, 2), v downwards, of unit vectors\n"
          "(N, 3) of the surface's frame; lod: the mip level, which may lie between two.")
      .def(
          "at",
          [](const OpenedSurface& s, double u, double v, double lod) {
            return new OpenedModel("place", {s.brdf().at(u, v, lod), {}, "{}"});
          },
          nb::arg("u"), nb::arg("v"), nb::arg("lod") = 0.0, nb::rv_policy::take_ownership,
          "The Model of a place, in its own frame.")
      .def("albedo", &albedo_of, "The largest share of light that a texel reflects, and where.")
      .def("export", &exported, nb::arg("to"), nb::arg("folder") = nb::none(), nb::arg("name") = "brdf",
           nb::arg("exact") = false,
           "Files by name, as `burnish export`: shaders, ktx2, exr, png, gltf, three, html.")
      .def(
          "write",
          [](const OpenedSurface& s, const std::filesystem::path& path) {
            write_then_rename(path, format_surface({s.brdf(), s.notes}));
          },
          nb::arg("path"), "The .burnish file.");
  m.def("open_surface", &open_surface, nb::arg("path"), nb::rv_policy::take_ownership,
        "Reads the .burnish file of a surface.");
  m.def("fit_surface", &fit_surface, nb::arg("capture"), nb::kw_only(), nb::arg("lobes") = 6,
        nb::arg("lobe_bytes") = 24 << 10, nb::arg("book").none() = nb::none(),
        nb::arg("normals") = nb::none(), nb::arg("rounds").none() = nb::none(), nb::arg("widened") = false,
        nb::arg("seed") = 1, nb::arg("checkpoint") = nb::none(), nb::arg("pictures") = Capture::kBtfPictures,
        "(Surface, report) of a capture's folder, of a BTF, of which so many pictures are taken, or of a\n"
        "CSV of samples of texels, as `burnish fit-surface`. checkpoint: a file that a fit which is stopped\n"
        "leaves, and that is gone on from if it is there; removed at the end.");
}

}  // namespace burnish::python
