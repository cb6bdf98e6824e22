// SPDX-License-Identifier: Apache-2.0
#include "opened.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/io/neural.h>
#include <burnish/io/np.h>
#include <burnish/io/open_source.h>
#include <burnish/io/text_reader.h>

namespace burnish::wasm {

namespace {

constexpr double kCoarsest = 64;  // the level of detail with one texel
constexpr std::size_t kMaxEntries = 100'000;

// Returns the first words of a file's rows.
std::vector<std::string> row_names(const FileBytes& file) {
  std::vector<std::string> names;
  for (TextReader reader(file); names.size() < kMaxEntries && reader.next_content_line();)
    names.push_back(printable(trimmed(reader.line().substr(0, reader.line().find(','))), 80));
  return names;
}

// Opens the named material of a file with several, or the first one.
Opened open_entry(std::string file, std::vector<std::string> names, std::string wanted, const auto& parse) {
  if (wanted.empty()) {
    if (names.empty()) throw Error::in_file(file, "at least one material", "none");
    wanted = names.front();
  }
  Source source = parse(wanted);
  source.name = fmt::format("{}#{}", file, wanted);
  if (names.size() < 2) names.clear();
  return {std::move(source), {}, std::move(names)};
}

Opened open_book(const FileBytes& file, const std::string& entry) {
  const MaterialBook book = parse_book(file);
  std::vector<std::string> names;
  for (const MaterialBook::Material& m :
       book.materials().first(std::min(book.materials().size(), kMaxEntries)))
    names.push_back(m.name);
  return open_entry(file.name, std::move(names), entry, [&](const std::string& name) {
    const auto found = book.find(name);
    if (!found) throw Error::in_file(file.name, "the name of one of its materials", in_quotes(name));
    Source source = to_source(file.name, {.brdf = book.brdf(*found), .lambda_nm = {}});
    source.findings.format = "material of a book";
    return source;
  });
}

Opened open_surface(const FileBytes& file) {
  SurfaceModel surface = parse_surface(file);
  Source mean = to_source(file.name, {.brdf = surface.brdf.at(0.5, 0.5, kCoarsest), .lambda_nm = {}});
  return {std::move(mean), std::move(surface), {}};
}

// Opens codes that are followed by their decoder.
Opened open_np(const FileBytes& file, std::size_t decoder_at, const std::string& entry) {
  if (decoder_at > file.bytes.size()) throw Error::in_file(file.name, "a decoder behind the codes", "none");
  const auto cut = file.bytes.begin() + static_cast<std::ptrdiff_t>(decoder_at);
  const FileBytes codes{file.name, {file.bytes.begin(), cut}};
  const auto decoder = parse_np_decoder({"decoder.f32", {cut, file.bytes.end()}});
  return open_entry(file.name, row_names(codes), entry, [&](const std::string& name) -> Source {
    NpFile parsed = parse_np(codes, name, decoder);
    return {file.name, std::move(parsed.brdf), std::move(parsed.findings)};
  });
}

}  // namespace

Opened open_bytes(FileBytes file, const Json& a, const OpenOptions& options) {
  if (file.bytes.empty()) throw Error::in_file(file.name, "at least one byte", "an empty file");
  const std::string entry = a.value("entry", "");
  if (a.contains("decoderAt")) return open_np(file, a.at("decoderAt").get<std::size_t>(), entry);
  if (looks_like_np(file.text()))
    throw Error::in_file(file.name, "the decoder of these codes (.f32) given with them", "the codes alone");
  if (looks_like_surface(file.bytes)) return open_surface(file);
  if (looks_like_book(file.bytes)) return open_book(file, entry);
  if (!entry.empty() || (!looks_like_model(file.bytes) && looks_like_neural(file.text())))
    return open_entry(file.name, row_names(file), entry, [&](const std::string& name) -> Source {
      NeuralFile parsed = parse_neural(file, name);
      return {file.name, std::move(parsed.brdf), std::move(parsed.findings)};
    });
  return {parse_source(file, options), {}, {}};
}

}  // namespace burnish::wasm
