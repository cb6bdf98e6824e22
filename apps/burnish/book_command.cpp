// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/library/book_of_library.h>
#include <burnish/math/parallel.h>

#include "book_text.h"
#include "commands.h"
#include "counted.h"
#include "json_output.h"
#include "progress.h"
#include "source_arguments.h"
#include "usage.h"

namespace burnish::cli {

namespace {

struct BookArguments {
  std::string place, out, shared;
  OpenOptions open;
  BookOptions options;
  int threads = 0;
  bool json = false;
};

void print_made(const BookArguments& arguments, const BookOfLibrary& made, std::size_t skipped) {
  if (arguments.json) {
    auto json = book_json(made.book);
    json["output"] = arguments.out;
    json["left_out"] = nlohmann::ordered_json::array();
    for (const auto& [entry, reason] : made.left_out)
      json["left_out"].push_back({{"name", entry.name}, {"path", entry.argument}, {"reason", reason}});
    json["skipped"] = skipped;
    return print_as_json(json);
  }
  fmt::print("book       {}\n", book_line(made.book));
  for (const auto& [entry, reason] : made.left_out)
    fmt::print("left out   {}: {}\n", entry.name, short_message(reason));
  if (skipped > 0) fmt::print("skipped    {}, no measurements\n", counted(skipped, "file"));
  fmt::print("written    {}\n", arguments.out);
}

void make(const BookArguments& arguments) {
  check_ending(arguments.out, {".burnish"});
  check_writable(arguments.out);
  const ThreadLimit limit(arguments.threads);
  MaterialBook shared;
  if (!arguments.shared.empty()) shared = parse_book(read_file(arguments.shared));
  std::vector<std::string> skipped;
  const std::vector<LibraryEntry> entries =
      library_entries(arguments.place, {arguments.out, arguments.shared}, &skipped);
  const BookOfLibrary made = [&] {
    Progress progress("reading");
    return book_of_library(entries, arguments.open, arguments.options,
                           arguments.shared.empty() ? nullptr : &shared, progress.bar());
  }();
  write_then_rename(arguments.out, format_book(made.book));
  print_made(arguments, made, skipped.size());
  std::fflush(stdout);
  if (!made.left_out.empty())
    throw Error(fmt::format("{} of {} materials are not in the book; all other materials are",
                            made.left_out.size(), entries.size()));
}

}  // namespace

void add_book_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "book",
      "Write a book: tables that the materials of a library share, as a prior for sparse measurements");
  verb->footer(
      "A book's material is opened as book:FILE#NAME; `burnish fit PAIRS --book FILE` completes a few "
      "measured pairs. "
      "See docs/guide/library.md.\n"
      "Examples: burnish book measurements -o library.burnish\n"
      "          burnish book list.txt -o library.burnish --budget 32K --bytes-a-material 32\n"
      "          burnish book new.txt -o new.burnish --shared library.burnish\n"
      "          burnish fit pairs.csv --book library.burnish -o paint.burnish");
  auto arguments = std::make_shared<BookArguments>();
  verb->add_option("LIST", arguments->place,
                   "Names a folder of isotropic measurements of one channel or three, or a text with an "
                   "argument of `burnish fit` on each line.")
      ->required();
  verb->add_option("-o,--output,--out", arguments->out, "Names the file to write.")->required();
  CLI::Option* bytes =
      verb->add_option(
              "--budget,--bytes", arguments->options.bytes,
              "Spends at most this many bytes on the tables that the materials share; K counts as 1024.")
          ->transform(CLI::AsSizeValue(false))
          ->capture_default_str();
  CLI::Option* each =
      verb->add_option("--bytes-a-material", arguments->options.bytes_a_material,
                       "Spends at most this many bytes on each material's weights, one byte a weight.")
          ->check(in_range(std::size_t{4}, MaterialBook::kMaxComponents))
          ->capture_default_str();
  verb->add_option("--shared", arguments->shared,
                   "Takes the shared tables of this book, and finds weights alone.")
      ->excludes(bytes)
      ->excludes(each);
  verb->add_option("--seed", arguments->options.seed, "Chooses the pairs that are drawn of each material.")
      ->check(at_least_zero())
      ->capture_default_str();
  add_open_options(*verb, arguments->open);
  verb->add_option("--threads", arguments->threads, "Uses at most this many threads; 0 uses all.")
      ->check(in_range(0, 1024));
  verb->add_flag("--json", arguments->json, "Prints the summary as JSON.");
  verb->callback([arguments] { make(*arguments); });
}

}  // namespace burnish::cli
