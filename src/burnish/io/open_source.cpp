#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include <burnish/baselines/baseline_file.h>
#include <burnish/book/book_file.h>
#include <burnish/io/alta.h>
#include <burnish/io/astm.h>
#include <burnish/io/cornell.h>
#include <burnish/io/csv.h>
#include <burnish/io/fred.h>
#include <burnish/io/klems.h>
#include <burnish/io/mbsdf.h>
#include <burnish/io/merl.h>
#include <burnish/io/neural.h>
#include <burnish/io/np.h>
#include <burnish/io/open_source.h>
#include <burnish/io/openmaterial.h>
#include <burnish/io/rgl.h>
#include <burnish/io/speos.h>
#include <burnish/io/tensor_tree_xml.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/utf16.h>
#include <burnish/io/utia.h>
#include <burnish/io/zemax.h>
#include <burnish/math/angles.h>
#include <burnish/math/closest_name.h>
#include <burnish/surface/surface_file.h>

namespace burnish {

namespace {

/// What the readers of tables return.
template <class File>
Source from_table(const FileBytes& file, File parsed) {
  return {file.name, std::move(parsed.table), std::move(parsed.findings)};
}

Source from_samples(const FileBytes& file, SampleFile parsed, SampleRule rule = SampleRule::kriged) {
  return {file.name, ScatteredBrdf(std::move(parsed.samples), rule), std::move(parsed.findings)};
}

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

/// Two whole numbers of a text such as "3,4"; nothing where it is no such text or one is negative.
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

/// Throws Error if the text is no file and nearly the name of an analytic model.
void check_spelling(const std::string& spec) {
  if (std::error_code none; std::filesystem::exists(spec, none)) return;
  std::vector<std::string_view> names;
  for (const AnalyticModel& model : analytic_models()) names.push_back(model.name);
  const std::string_view name = std::string_view(spec).substr(0, spec.find(':'));
  if (const std::string meant = did_you_mean(name, names); !meant.empty())
    throw Error(fmt::format("{}: expected a file or an analytic model, found neither{}", spec, meant));
}

Source parse_text(const FileBytes& file, const OpenOptions& options) {
  const std::string_view text = file.text();
  if (looks_like_openmaterial(text)) return from_samples(file, parse_openmaterial(file, options));
  if (looks_like_baseline(text)) return to_source(file.name, parse_baseline(file));
  if (looks_like_tensor_tree(text)) return from_table(file, parse_tensor_tree(file, options));
  if (looks_like_klems(text)) return from_table(file, parse_klems(file, options));
  if (looks_like_zemax(text)) return from_table(file, parse_zemax(file));
  if (looks_like_speos(text)) return from_table(file, parse_speos(file, options));
  if (looks_like_alta(text)) return from_samples(file, parse_alta(file, options));
  if (looks_like_neural(text)) return from_neural(file, {});
  if (looks_like_fred(text)) return from_samples(file, parse_fred(file, options));
  if (looks_like_astm(text)) return from_samples(file, parse_astm(file, options));
  if (looks_like_csv(text)) return from_samples(file, parse_csv(file, options));
  if (looks_like_cornell(text))
    return from_samples(file, parse_cornell(file, options), SampleRule::mean_in_half_difference);
  if (looks_like_np(text))
    throw Error::in_file(file.name, "np:FILE#NAME for one of its codes, a decoder.f32 beside it",
                         "the file alone");
  throw Error(file.name, 0,
              "a measurement, neural encoding, baseline or model (`burnish help formats` lists what is read)",
              fmt::format("something that starts with {}", in_quotes(text.substr(0, 16))));
}

Source parse_file(const FileBytes& file, const OpenOptions& options) {
  // Binary formats first: their first bytes are unmistakable.
  if (looks_like_book(file.bytes))
    throw Error::in_file(file.name,
                         "book:FILE#NAME for one material of a book (`burnish info FILE` names them)",
                         "the book alone");
  if (looks_like_surface(file.bytes))
    throw Error::in_file(
        file.name, "surface:FILE#COLUMN,ROW for one texel of a surface (`burnish info FILE` says how many)",
        "the surface alone");
  if (looks_like_model(file.bytes)) return to_source(file.name, parse_model(file));
  if (looks_like_rgl(file.bytes)) return from_table(file, parse_rgl(file, options));
  if (looks_like_mbsdf(file.bytes)) return from_table(file, parse_mbsdf(file));
  if (looks_like_utia(file.bytes)) return from_table(file, parse_utia(file));
  if (looks_like_merl(file.bytes)) return from_table(file, parse_merl(file));
  if (const auto converted = from_utf16(file)) return parse_text(*converted, options);
  return parse_text(file, options);
}

}  // namespace

Source parse_source(const FileBytes& file, const OpenOptions& options) {
  Source source = parse_file(file, options);
  source.clamp_negatives = options.clamp_negatives;
  return source;
}

bool looks_like_source(const FileBytes& file) {
  constexpr std::size_t kHead = 1 << 16;
  const std::span<const std::byte> bytes = file.bytes;
  // pictures are OpenEXR files too, and lists JSON
  const bool is_exr = file.text().starts_with("\x76\x2f\x31\x01");
  if (is_exr && file.text().substr(0, kHead).find("burnish") == std::string_view::npos) return false;
  if (looks_like_book(bytes) || looks_like_surface(bytes) || looks_like_model(bytes) ||
      looks_like_rgl(bytes) || looks_like_mbsdf(bytes) || looks_like_utia(bytes) || looks_like_merl(bytes))
    return true;
  const std::optional<FileBytes> converted = from_utf16(file);
  const std::string_view text = converted ? converted->text() : file.text();
  return looks_like_openmaterial(text) ||
         (looks_like_baseline(text) && text.find("\"kind\"") != std::string_view::npos) ||
         looks_like_tensor_tree(text) || looks_like_klems(text) || looks_like_zemax(text) ||
         looks_like_speos(text) || looks_like_alta(text) || looks_like_neural(text) ||
         looks_like_fred(text) || looks_like_astm(text) || looks_like_csv(text) || looks_like_cornell(text) ||
         looks_like_np(text);
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
