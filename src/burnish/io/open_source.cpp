// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <burnish/baselines/baseline_file.h>
#include <burnish/book/book_file.h>
#include <burnish/io/formats.h>
#include <burnish/io/neural.h>
#include <burnish/io/np.h>
#include <burnish/io/open_source.h>
#include <burnish/io/openmaterial.h>
#include <burnish/io/part_choice.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/utf16.h>
#include <burnish/math/angles.h>
#include <burnish/math/closest_name.h>
#include <burnish/surface/surface_file.h>

namespace burnish {

namespace {

Source from_neural(const FileBytes& file, std::string_view name) {
  NeuralFile parsed = parse_neural(file, name);
  return {fmt::format("{}#{}", file.name, parsed.name), std::move(parsed.brdf), std::move(parsed.findings)};
}

Source from_np(std::string_view address) {
  NpFile parsed = open_np(address);
  return {fmt::format("np:{}", address), std::move(parsed.brdf), std::move(parsed.findings)};
}

Source from_book(const std::string& file, std::string_view name) {
  const MaterialBook book = parse_book(read_file(file));
  const auto found = book.find(name);
  if (!found) {
    std::vector<std::string_view> names;
    for (const MaterialBook::Material& material : book.materials()) names.push_back(material.name);
    throw Error::in_file(file, fmt::format("a material named '{}'", name),
                         fmt::format("{} others{}", names.size(), did_you_mean(name, names)));
  }
  Source source =
      to_source(fmt::format("book:{}#{}", file, name), {.brdf = book.brdf(*found), .lambda_nm = {}});
  source.findings.format = "material of a book";
  return source;
}

/// Returns the two whole numbers of a text such as "3,4"; nothing for any other text or a negative number.
std::optional<std::array<int, 2>> texel_of(std::string_view text) {
  std::array<int, 2> texel{};
  const char* const end = text.data() + text.size();
  const auto [comma, bad_x] = std::from_chars(text.data(), end, texel[0]);
  if (bad_x != std::errc() || comma == end || *comma != ',') return std::nullopt;
  const auto [last, bad_y] = std::from_chars(comma + 1, end, texel[1]);
  if (bad_y != std::errc() || last != end || texel[0] < 0 || texel[1] < 0) return std::nullopt;
  return texel;
}

Source from_surface(const std::string& file, std::string_view name) {
  const SpatialBrdf surface = parse_surface(read_file(file)).brdf;
  const auto texel = texel_of(name);
  if (!texel || (*texel)[0] >= surface.width() || (*texel)[1] >= surface.height())
    throw Error::in_file(
        file, fmt::format("the column and row of one of {} x {} texels", surface.width(), surface.height()),
        in_quotes(name));
  Source source = to_source(fmt::format("surface:{}#{}", file, name),
                            {.brdf = surface.texel((*texel)[0], (*texel)[1]), .lambda_nm = {}});
  source.findings.format = "texel of a surface";
  return source;
}

Source from_spec(const std::string& spec) {
  AnalyticBrdf brdf = parse_analytic(spec);
  Findings findings;
  findings.format = "analytic";
  findings.description = fmt::format("{}: {}", brdf.model().description, format_analytic(brdf));
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  return {spec, std::move(brdf), std::move(findings)};
}

/// Throws Error if the text is no file but nearly the name of an analytic model.
void check_spelling(const std::string& spec) {
  if (std::error_code none; std::filesystem::exists(spec, none)) return;
  std::vector<std::string_view> names;
  for (const AnalyticModel& model : analytic_models()) names.push_back(model.name);
  const std::string_view name = std::string_view(spec).substr(0, spec.find(':'));
  if (const std::string meant = did_you_mean(name, names); !meant.empty())
    throw Error(fmt::format("{}: expected a file or an analytic model, found neither{}", spec, meant));
}

/// The format that a file looks like, and the file's text if it was converted from UTF-16.
struct ToldFile {
  const Format* format;
  std::optional<FileBytes> converted;
};

ToldFile told(const FileBytes& file) {
  // Binary formats come first, because their first bytes are unmistakable.
  if (const Format* binary = binary_format_of(file)) return {binary, {}};
  std::optional<FileBytes> converted = from_utf16(file);
  const Format* format = text_format_of(converted ? *converted : file);
  return {format, std::move(converted)};
}

}  // namespace

Source parse_source(const FileBytes& file, const OpenOptions& options) {
  const auto [format, converted] = told(file);
  const FileBytes& bytes = converted ? *converted : file;
  if (!format)
    throw Error(
        bytes.name, 0,
        "a measurement, neural encoding, baseline or model (`burnish help formats` lists what is read)",
        fmt::format("something that starts with {}", in_quotes(bytes.text().substr(0, 16))));
  Source source = format->parse(bytes, options);
  check_block(bytes.name, source.findings, options);
  source.clamp_negatives = options.clamp_negatives;
  return source;
}

bool looks_like_source(const FileBytes& file) {
  constexpr std::size_t kHead = 1 << 16;
  // Pictures are OpenEXR files too.
  const bool is_exr = file.text().starts_with("\x76\x2f\x31\x01");
  if (is_exr && file.text().substr(0, kHead).find("burnish") == std::string_view::npos) return false;
  const auto [format, converted] = told(file);
  if (!format) return false;
  // Lists are JSON, as baselines are.
  const std::string_view text = converted ? converted->text() : file.text();
  return !looks_like_baseline(text) || looks_like_openmaterial(text) ||
         text.find("\"kind\"") != std::string_view::npos;
}

Source open_source(const std::string& spec, const OpenOptions& options) {
  if (is_analytic_spec(spec)) return from_spec(spec);
  constexpr std::string_view kNeural = "nbrdf:", kNp = "np:", kBook = "book:", kSurface = "surface:";
  if (spec.starts_with(kNp)) return from_np(std::string_view(spec).substr(kNp.size()));
  if (spec.starts_with(kNeural)) {
    const std::string rest = spec.substr(kNeural.size());
    const std::size_t mark = std::min(rest.rfind('#'), rest.size());
    return from_neural(read_file(rest.substr(0, mark)),
                       std::string_view(rest).substr(std::min(mark + 1, rest.size())));
  }
  if (spec.starts_with(kBook) && spec.find('#') != std::string::npos) {
    const std::string rest = spec.substr(kBook.size());
    return from_book(rest.substr(0, rest.rfind('#')), std::string_view(rest).substr(rest.rfind('#') + 1));
  }
  if (spec.starts_with(kSurface) && spec.find('#') != std::string::npos) {
    const std::string rest = spec.substr(kSurface.size());
    return from_surface(rest.substr(0, rest.rfind('#')), std::string_view(rest).substr(rest.rfind('#') + 1));
  }
  check_spelling(spec);
  return parse_source(read_file(spec), options);
}

}  // namespace burnish
