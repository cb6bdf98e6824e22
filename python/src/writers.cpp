#include <string>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <burnish/file.h>
#include <burnish/io/csv.h>
#include <burnish/io/merl.h>
#include <burnish/io/rgl.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/rgl_builder.h>

#include "opened_brdf.h"

namespace burnish::python {

namespace {

namespace fs = std::filesystem;
using Released = nb::call_guard<nb::gil_scoped_release>;

void write_model(const fs::path& path, const OpenedModel& model) {
  write_then_rename(path, format_model(to_model(model)));
}

void write_rgl(const fs::path& path, const OpenedBrdf& source) {
  RglOptions options;
  options.lambda_nm = source.source().findings.lambda_nm;
  options.description = source.source().name;
  write_then_rename(path, format_rgl(make_rgl_table(source.ref(), options)));
}

void write_csv(const fs::path& path, const OpenedBrdf& source, std::size_t count, double noise,
               std::uint64_t seed) {
  const Samples* samples = source.source().samples();
  write_then_rename(path, samples_csv(samples ? *samples : measure(source.ref(), {count, noise, seed}),
                                      source.source().findings.lambda_nm));
}

}  // namespace

void bind_writers(nb::module_& m) {
  m.def("write_model", &write_model, nb::arg("path"), nb::arg("model"), Released(),
        "Writes the native file, a multi-part OpenEXR image that open_source reads back to the last bit.");
  m.def(
      "write_merl", [](const fs::path& path, const OpenedBrdf& source) { write_merl(path, source.ref()); },
      nb::arg("path"), nb::arg("source"), Released(),
      "Writes an isotropic source as a MERL table of 90 x 90 x 180 entries.");
  m.def(
      "write_rgl", &write_rgl, nb::arg("path"), nb::arg("source"), Released(),
      "Writes a source as a file of the RGL material database, which Mitsuba's `measured` and pbrt-v4 read.");
  m.def("write_csv", &write_csv, nb::arg("path"), nb::arg("source"), nb::kw_only(),
        nb::arg("count") = 100'000, nb::arg("noise") = 0.0, nb::arg("seed") = 1, Released(),
        "Writes a scattered source's samples, or `count` samples measured of any other.");
}

}  // namespace burnish::python
