// SPDX-License-Identifier: Apache-2.0
#include <burnish/book/book_file.h>

#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return burnish::fuzz(data, size, [](const burnish::FileBytes& file, const burnish::OpenOptions&) {
    const burnish::MaterialBook book = burnish::parse_book(file);
    if (!book.materials().empty()) burnish::check_values(book.brdf(0));
    // A parsed book can be written, and reads back equal.
    const std::string again = burnish::format_book(book);
    const auto* bytes = reinterpret_cast<const std::byte*>(again.data());
    if (burnish::parse_book({"written file", {bytes, bytes + again.size()}}) != book) __builtin_trap();
  });
}
