#include <string>
#include <vector>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/file.h>
#include <burnish/io/convert.h>

#include "opened_brdf.h"

namespace burnish::python {

namespace {

void write_model(const std::filesystem::path& path, const OpenedModel& model) {
  write_then_rename(path, format_model_as(path, to_model(model)));
}

void write_baseline(const std::filesystem::path& path, const OpenedBaseline& model) {
  write_then_rename(path, format_baseline(model.baseline()));
}

std::vector<std::string> write_converted(const OpenedBrdf& source, const std::filesystem::path& path,
                                         const std::string& format, std::size_t count, std::uint64_t seed,
                                         bool entries, int cells, bool notes) {
  Converted converted = without_gil(FunctionWatch({&source}), [&] {
    return convert(source.source(), format,
                   {.count = count, .seed = seed, .entries = entries, .cells = cells, .notes = notes});
  });
  write_then_rename(path, converted.bytes);
  return std::move(converted.losses);
}

}  // namespace

void bind_writers(nb::module_& m) {
  m.def("write_model", &write_model, nb::arg("path"), nb::arg("model"),
        nb::call_guard<nb::gil_scoped_release>(),
        "Writes the native file, which open_source reads back to the last bit: a multi-part OpenEXR\nimage, "
        "or where path ends in .burnish its compact twin, without notes.");
  m.def("write_model", &write_baseline, nb::arg("path"), nb::arg("model"),
        nb::call_guard<nb::gil_scoped_release>(),
        "Writes a baseline's JSON, which open_source reads back to the last bit.");
  const ConvertOptions defaults;
  m.def("convert", &write_converted, nb::arg("source"), nb::arg("path"), nb::arg("format"), nb::kw_only(),
        nb::arg("count") = defaults.count, nb::arg("seed") = defaults.seed,
        nb::arg("entries") = defaults.entries, nb::arg("cells") = defaults.cells,
        nb::arg("notes") = defaults.notes,
        "Writes a source in another format and says what that lost, a phrase each.\n\n"
        "format: \"merl\", \"utia\", \"rgl\" (for Mitsuba's `measured` and pbrt-v4), \"mbsdf\", "
        "\"zemax\", \"tensortree\",\n\"openmaterial\", \"astm\", \"csv\", \"exr\" (slices), or of a "
        "model its files \"model\" (OpenEXR) or\n\"burnish\". count, seed: samples drawn for astm, csv and "
        "openmaterial; entries: a table's entries instead;\ncells: along each polar angle of merl, mbsdf and "
        "exr; notes: those of the fit are kept in burnish.");
}

}  // namespace burnish::python
