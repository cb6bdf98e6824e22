// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/file.h>
#include <burnish/io/convert.h>
#include <burnish/io/formats.h>
#include <burnish/math/closest_name.h>

#include "opened_brdf.h"
#include "texts.h"

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

/// Lists the formats that an argument applies to.
std::string names_with(bool Format::*argument) {
  std::vector<std::string_view> names;
  for (const Format& format : formats())
    if (format.write && format.*argument) names.push_back(format.to);
  return names.size() == 1 ? std::string(names[0]) : listed(names, "and");
}

}  // namespace

void bind_writers(nb::module_& m) {
  m.def("write_model", &write_model, nb::arg("path"), nb::arg("model"),
        nb::call_guard<nb::gil_scoped_release>(),
        "Writes the file of a model, which open_source reads back to the last bit. It is a multi-part\n"
        "OpenEXR image, or where path ends in .burnish the compact file without notes.");
  m.def("write_model", &write_baseline, nb::arg("path"), nb::arg("model"),
        nb::call_guard<nb::gil_scoped_release>(),
        "Writes a baseline's JSON, which open_source reads back to the last bit.");
  const ConvertOptions defaults;
  m.def("convert", &write_converted, nb::arg("source"), nb::arg("path"), nb::arg("format"), nb::kw_only(),
        nb::arg("count") = defaults.count, nb::arg("seed") = defaults.seed,
        nb::arg("entries") = defaults.entries, nb::arg("cells") = defaults.cells,
        nb::arg("notes") = defaults.notes,
        fmt::format("Writes a source in another format. Returns what was lost, one phrase for each loss.\n"
                    "\n"
                    "format: {}. \"rgl\" is for Mitsuba's `measured` and pbrt-v4; \"exr\" has slices; "
                    "\"model\" (OpenEXR) and\n"
                    "\"burnish\" are the files of a model.\n"
                    "count, seed: the samples drawn for {}.\n"
                    "entries: writes the entries of a table instead of drawn samples.\n"
                    "cells: the cells along each polar angle of {}.\n"
                    "notes: keeps the notes of the fit in {}.",
                    quoted_names(convert_formats()), names_with(&Format::takes_count),
                    names_with(&Format::takes_cells), names_with(&Format::takes_notes))
            .c_str());
}

}  // namespace burnish::python
