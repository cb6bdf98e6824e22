// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include <burnish/io/open_source.h>
#include <burnish/library/book_of_library.h>
#include <burnish/math/parallel.h>

namespace burnish {

BookOfLibrary book_of_library(const std::vector<LibraryEntry>& entries, const OpenOptions& open,
                              const BookOptions& options, const MaterialBook* shared,
                              const std::function<void(double fraction)>& progress) {
  const std::array<int, 3> sides =
      shared ? std::array{shared->layout().width, shared->layout().height, shared->layout().depth}
             : book_sides(options);

  // each at the nodes
  std::vector<std::optional<BookMaterial>> found(entries.size());
  std::vector<std::string> reasons(entries.size());
  std::mutex mutex;
  std::size_t done = 0;
  for_each_chunk(entries.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
    try {
      found[k] = book_material(open_source(entries[k].argument, open), entries[k].name, sides, options.seed);
    } catch (const std::exception& error) {
      reasons[k] = error.what();
    }
    const std::lock_guard lock(mutex);
    ++done;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(entries.size()));
  });

  // those that can be in a book
  BookOfLibrary made;
  std::vector<BookMaterial> materials;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (found[k])
      materials.push_back(std::move(*found[k]));
    else
      made.left_out.push_back({entries[k], std::move(reasons[k])});
  }
  made.book = shared ? with_materials(*shared, materials) : make_book(sides, materials, options);
  return made;
}

}  // namespace burnish
