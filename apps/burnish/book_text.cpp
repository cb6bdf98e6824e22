// SPDX-License-Identifier: Apache-2.0
#include "book_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "counted.h"

namespace burnish::cli {

namespace {

std::vector<std::size_t> component_counts(const MaterialBook& book) {
  std::vector<std::size_t> counts;
  for (const BookAxis& axis : book.axes()) counts.push_back(axis.component_count());
  return counts;
}

std::vector<float> residuals(const MaterialBook& book) {
  std::vector<float> all;
  for (const BookAxis& axis : book.axes()) all.push_back(axis.residual);
  return all;
}

}  // namespace

std::string book_line(const MaterialBook& book) {
  return fmt::format("{} of {} bytes each, {} bytes shared", counted(book.materials().size(), "material"),
                     book.bytes_a_material(), book.shared_bytes());
}

nlohmann::ordered_json book_json(const MaterialBook& book) {
  nlohmann::ordered_json json{{"format", "book"},
                              {"shared_bytes", book.shared_bytes()},
                              {"bytes_a_material", book.bytes_a_material()},
                              {"nodes", {book.layout().width, book.layout().height, book.layout().depth}},
                              {"components", component_counts(book)},
                              {"residuals", residuals(book)}};
  json["materials"] = nlohmann::ordered_json::array();
  for (const MaterialBook::Material& material : book.materials()) json["materials"].push_back(material.name);
  return json;
}

void print_book(const std::string& name, const MaterialBook& book) {
  const auto line = [](const char* label, const std::string& text) { fmt::print("{:<13}{}\n", label, text); };
  line("name", name);
  line("format", "book of a library");
  line("book", book_line(book));
  line("volume", fmt::format("{} x {} x {} nodes of theta_h, theta_d, phi_d", book.layout().width,
                             book.layout().height, book.layout().depth));
  line("components",
       fmt::format("{} of brightness and both axes of colour", fmt::join(component_counts(book), ", ")));
  line("left over",
       fmt::format("{:.3f} of the logarithms at nodes, root mean square", fmt::join(residuals(book), ", ")));
  for (const MaterialBook::Material& material : book.materials()) line("material", material.name);
}

}  // namespace burnish::cli
