// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <burnish/book/material_book.h>

namespace burnish::cli {

/// Describes the size of a book in a line: materials, bytes of each, bytes that they share.
std::string book_line(const MaterialBook& book);

/// Returns the JSON of `burnish info --json` for a book: format, shared_bytes, bytes_a_material, nodes, and the
/// materials' names. Two members have one value for each axis of colour: components, their number, and residuals.
nlohmann::ordered_json book_json(const MaterialBook& book);

/// Prints the report of `burnish info` on a book.
void print_book(const std::string& name, const MaterialBook& book);

}  // namespace burnish::cli
