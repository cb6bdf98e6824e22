#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <burnish/book/material_book.h>

namespace burnish::cli {

/// How much is in a book, in a line.
std::string book_line(const MaterialBook& book);

/// What `burnish info --json` says of a book: format, shared_bytes, bytes_a_material, nodes, components of each axis of
/// colour, residuals of these, and the materials' names.
nlohmann::ordered_json book_json(const MaterialBook& book);

/// Prints what `burnish info` says of a book.
void print_book(const std::string& name, const MaterialBook& book);

}  // namespace burnish::cli
