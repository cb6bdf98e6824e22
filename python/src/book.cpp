// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/library/book_of_library.h>

#include "opened_brdf.h"
#include "texts.h"

namespace burnish::python {

namespace {

using Materials = std::variant<std::vector<std::string>, std::filesystem::path>;

// Makes a book. A material that cannot be in a book is an error.
std::shared_ptr<const MaterialBook> make(const Materials& materials, std::uint64_t bytes,
                                         std::size_t bytes_a_material, std::uint64_t seed,
                                         const std::shared_ptr<const MaterialBook>& shared) {
  const auto* arguments = std::get_if<std::vector<std::string>>(&materials);
  const std::vector<LibraryEntry> entries =
      arguments ? named_entries(*arguments) : library_entries(std::get<std::filesystem::path>(materials));
  const nb::gil_scoped_release released;
  BookOfLibrary made = book_of_library(
      entries, {}, {.bytes = bytes, .bytes_a_material = bytes_a_material, .seed = seed}, shared.get());
  if (!made.left_out.empty())
    throw Error(made.left_out.front().entry.argument + ": " + made.left_out.front().reason);
  return std::make_shared<const MaterialBook>(std::move(made.book));
}

OpenedModel* model_of(const MaterialBook& book, const std::string& name) {
  const auto found = book.find(name);
  if (!found) throw nb::key_error(name.c_str());
  return new OpenedModel(name, {.brdf = book.brdf(*found), .lambda_nm = {}});
}

}  // namespace

void bind_book(nb::module_& m) {
  nb::class_<MaterialBook>(
      m, "Book",
      "Tables that the materials of a library share, and the weights of each material in a few bytes.")
      .def_prop_ro("names",
                   [](const MaterialBook& book) {
                     std::vector<std::string> names;
                     for (const MaterialBook::Material& material : book.materials())
                       names.push_back(material.name);
                     return names;
                   })
      .def_prop_ro("shared_bytes", &MaterialBook::shared_bytes)
      .def_prop_ro("bytes_a_material", &MaterialBook::bytes_a_material)
      .def("__repr__",
           [](const MaterialBook& book) {
             return fmt::format("<burnish book: {}, {} shared, at most {} a material>",
                                counted(book.materials().size(), "material"),
                                counted(book.shared_bytes(), "byte"), book.bytes_a_material());
           })
      .def("__len__", [](const MaterialBook& book) { return book.materials().size(); })
      .def("__getitem__", &model_of, nb::arg("name"), nb::rv_policy::take_ownership,
           "Returns a material as a Model.")
      .def(
          "write",
          [](const MaterialBook& book, const std::filesystem::path& path) {
            write_then_rename(path, format_book(book));
          },
          nb::arg("path"));
  m.def(
      "open_book",
      [](const std::filesystem::path& path) {
        return std::make_shared<const MaterialBook>(parse_book(read_file(path)));
      },
      nb::arg("path"), "Reads a book from the file that Book.write or `burnish book` wrote.");
  m.def("book", &make, nb::arg("materials"), nb::kw_only(), nb::arg("bytes") = BookOptions().bytes,
        nb::arg("bytes_a_material") = BookOptions().bytes_a_material, nb::arg("seed") = BookOptions().seed,
        nb::arg("shared") = nb::none(),
        "Makes a book as `burnish book` does, for fit(..., book=).\n"
        "\n"
        "materials: a folder, the path of a list, or arguments of open_source. All materials are isotropic\n"
        "and have one channel or three. The first material that cannot be in a book raises an Error.\n"
        "bytes: the most bytes of the tables that all materials share.\n"
        "bytes_a_material: the most bytes of the weights of one material.\n"
        "shared: a Book whose tables are reused, so that only weights are fitted.");
}

}  // namespace burnish::python
