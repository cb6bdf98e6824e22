// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/io/illuminant.h>
#include <burnish/library/batch.h>

#include "fit_keywords.h"
#include "module.h"

namespace burnish::python {

namespace {

// Keywords of a batch besides the options of a fit.
constexpr std::string_view kOtherKeywords[] = {
    "to",           "exact",  "mips",          "compressed", "compact",     "resume",          "threads",
    "memory",       "studio", "keep_spectral", "illuminant", "has_cosine",  "clamp_negatives", "back_side",
    "has_cosine_o", "brf",    "part",          "band",       "scale_to_tis"};

using Materials = std::variant<std::vector<std::string>, std::filesystem::path>;

// Starts a batch. Iterating gives a dictionary for each material.
Batch* batch(const Materials& materials, const std::filesystem::path& folder,
             const std::vector<std::string>& to, bool exact, bool mips, bool compressed, bool compact,
             bool resume, int threads, std::uint64_t memory, const std::string& studio, bool keep_spectral,
             const std::string& illuminant, bool has_cosine, bool clamp_negatives, bool back_side,
             bool has_cosine_o, bool brf, const std::string& part, const std::string& band, bool scale_to_tis,
             const nb::kwargs& how) {
  if (to.empty() && (exact || mips || !compressed))
    throw Error("batch: expected to= with exact, mips or compressed=False, found no exports");
  open_illuminant(illuminant);  // checked even where no spectrum needs it
  BatchOptions options;
  options.folder = folder;
  options.compact = compact;
  options.threads = threads;
  options.memory = memory;
  options.resume = resume;
  options.studio = studio;
  options.open = {keep_spectral, illuminant,    has_cosine, clamp_negatives, back_side, has_cosine_o,
                  brf,           part_of(part), band,       scale_to_tis};
  options.exports.exact = exact;
  options.exports.mips = mips;
  options.exports.compressed = compressed;
  options.fit = [request = request_of("batch", how, kOtherKeywords)](bool isotropic) {
    return fit_options(request, isotropic);
  };
  for (const std::string& target : to) options.exports.to.push_back(export_target(target));
  const auto* arguments = std::get_if<std::vector<std::string>>(&materials);
  std::vector<LibraryEntry> entries =
      arguments ? named_entries(*arguments)
                : library_entries(std::get<std::filesystem::path>(materials), {folder});
  const nb::gil_scoped_release released;
  return new Batch(std::move(entries), std::move(options));
}

// Waits for the next material. Ctrl-C ends the wait.
nb::object next_of(Batch& batch) {
  std::optional<MaterialRecord> record;
  {
    const nb::gil_scoped_release released;
    record = batch.next([] {
      const nb::gil_scoped_acquire acquired;
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
    });
  }
  if (!record) throw nb::stop_iteration();
  nb::object row = from_json(to_json(*record));
  row["earlier"] = record->earlier;
  return row;
}

}  // namespace

void bind_batch(nb::module_& m) {
  nb::class_<Batch>(
      m, "Batch",
      "A running batch. Iterating over it yields a dictionary for each material as soon as it is done.")
      .def("__iter__", [](nb::handle self) { return nb::borrow(self); })
      .def("__next__", &next_of);
  m.def(
      "batch", &batch, nb::arg("materials"), nb::arg("folder"), nb::kw_only(),
      nb::arg("to") = std::vector<std::string>(), nb::arg("exact") = false, nb::arg("mips") = false,
      nb::arg("compressed") = true, nb::arg("compact") = true, nb::arg("resume") = false,
      nb::arg("threads") = 0, nb::arg("memory") = 0, nb::arg("studio") = BatchOptions().studio,
      nb::arg("keep_spectral") = false, nb::arg("illuminant") = "E", nb::arg("has_cosine") = false,
      nb::arg("clamp_negatives") = true, nb::arg("back_side") = false, nb::arg("has_cosine_o") = false,
      nb::arg("brf") = false, nb::arg("part") = "", nb::arg("band") = "", nb::arg("scale_to_tis") = false,
      nb::arg("how"), nb::rv_policy::take_ownership,
      "Fits a library as `burnish batch` does, and yields a dictionary for each material once it is done.\n"
      "A dictionary has name, argument, files, bytes, fetches, psnr and more, or reason where the fit\n"
      "failed. Its entry earlier is True where an earlier run did the material. The table of figures and\n"
      "the page are written after the last material. A batch that was stopped continues with resume=True.\n"
      "\n"
      "materials: a folder, the path of a list, or arguments of open_source. The batch passes\n"
      "keep_spectral, illuminant, has_cosine, clamp_negatives, back_side, has_cosine_o, brf, part, band and\n"
      "scale_to_tis on to open_source.\n"
      "to: exports, named as for export; exact, mips and compressed apply to them.\n"
      "compact: writes .burnish files; False writes OpenEXR files with notes.\n"
      "memory: the most bytes that the batch may use; 0 is four fifths of the memory.\n"
      "All other options are those of fit.");
}

}  // namespace burnish::python
