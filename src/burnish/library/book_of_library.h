// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burnish/book/material_book.h>
#include <burnish/fitting/book/make_book.h>
#include <burnish/io/open_options.h>
#include <burnish/library/entries.h>

namespace burnish {

/// A material that could not be taken into a book.
struct LeftOut {
  LibraryEntry entry;
  std::string reason;
};

/// A book of a library, and what is not in it.
struct BookOfLibrary {
  MaterialBook book;
  std::vector<LeftOut> left_out;  ///< in the library's order
};

/// Opens the materials, as many at once as there are threads, and makes a book of those that can be one's: see
/// make_book. With `shared` that book's shared part serves, and only the weights are found: see with_materials. The
/// same bits whatever the number of threads. `progress` is called with rising shares of the work done, from any
/// thread, one call at a time. Throws Error where too few are left, and as book_sides does.
BookOfLibrary book_of_library(const std::vector<LibraryEntry>& entries, const OpenOptions& open,
                              const BookOptions& options, const MaterialBook* shared = nullptr,
                              const std::function<void(double fraction)>& progress = {});

}  // namespace burnish
