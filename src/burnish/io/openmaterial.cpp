// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <burnish/io/openmaterial.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

using Json = nlohmann::json;

constexpr double kHalfPiOfSchema = 1.570796, kTwoPiOfSchema = 6.283185;
constexpr double kAngleSlack = 1e-5;      // angles may have six digits only
constexpr double kSameWavelength = 1e-6;  // relative tolerance of equal wavelengths
constexpr std::size_t kMaxRemark = 160;

using Angles = std::array<double, 3>;  // theta_i, theta_o, phi_o - phi_i

/// Returns the document. Errors name the file and the byte where its JSON ends.
Json parse_document(const FileBytes& file) {
  try {
    return Json::parse(file.text());
  } catch (const Json::parse_error& error) {
    throw Error(file.name, error.byte, "well-formed JSON", "something else");
  } catch (const Json::exception&) {
    throw Error::in_file(file.name, "well-formed JSON", "a number that is too large");
  }
}

const Json& member(const FileBytes& file, const Json& object, const char* key, Json::value_t type) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  const auto kind = [&] { return type == Json::value_t::array ? "an array" : "an object"; };
  if (!object.is_object() || found == object.end() || found->type() != type)
    throw Error::in_file(file.name, fmt::format("{} {}", kind(), key), "none");
  return *found;
}

std::vector<double> read_wavelengths(const FileBytes& file, const Json& list) {
  std::vector<double> lambda_m;
  if (list.empty() || list.size() > kMaxFileChannels)
    throw Error::in_file(file.name, fmt::format("1 to {} wavelengths", kMaxFileChannels),
                         fmt::format("{}", list.size()));
  for (const Json& value : list) {
    if (!value.is_number() || !(value.get<double>() > 0 && value.get<double>() < 1))
      throw Error::in_file(file.name, "wavelengths in metres", in_quotes(value.type_name()));
    if (!lambda_m.empty() && value.get<double>() <= lambda_m.back())
      throw Error::in_file(file.name, "increasing wavelengths", fmt::format("{} m", value.get<double>()));
    lambda_m.push_back(value.get<double>());
  }
  return lambda_m;
}

/// Returns the place of a wavelength in the list, or the list's size.
std::size_t place_of(std::span<const double> lambda_m, double lambda) noexcept {
  const auto near = [&](double other) { return std::abs(other - lambda) <= kSameWavelength * other; };
  return static_cast<std::size_t>(std::find_if(lambda_m.begin(), lambda_m.end(), near) - lambda_m.begin());
}

/// Returns the numbers of one row, or nothing if one of them is null.
std::optional<std::array<double, 5>> row_numbers(const FileBytes& file, const Json& row, std::size_t number) {
  constexpr std::array names{"wavelength", "incident angle", "exit angle", "azimuth", "value"};
  std::array<double, 5> values{};
  bool known = true;
  if (!row.is_array() || row.size() != values.size())
    throw Error::in_file(file.name, fmt::format("five numbers in row {} of lookupTable", number),
                         "another count");
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (row[k].is_null()) {
      known = false;
      continue;
    }
    if (!row[k].is_number() || !std::isfinite(row[k].get<double>()))
      throw Error::in_file(file.name, fmt::format("a number for the {} of row {}", names[k], number),
                           in_quotes(row[k].type_name()));
    values[k] = row[k].get<double>();
  }
  if (!known) return std::nullopt;
  for (const std::size_t k : {1, 2})
    if (!(values[k] >= 0 && values[k] <= kHalfPi + kAngleSlack))
      throw Error::in_file(file.name, fmt::format("the {} of row {} in [0, pi/2]", names[k], number),
                           fmt::format("{}", values[k]));
  if (!(std::abs(values[4]) <= std::numeric_limits<float>::max()))
    throw Error::in_file(file.name, fmt::format("a value below 1e38 in row {}", number),
                         fmt::format("{}", values[4]));
  return values;
}

/// Spectra by their angles, in the order in which the angles come.
struct SpectrumTable {
  std::map<Angles, std::size_t> places;
  std::vector<Angles> angles;
  std::vector<double> values;  // [angles][wavelength], NaN where no value stands
};

SpectrumTable collect(const FileBytes& file, const Json& rows, std::span<const double> lambda_m) {
  SpectrumTable table;
  const std::size_t bands = lambda_m.size();
  std::size_t number = 0;
  for (const Json& row : rows) {
    const auto read = row_numbers(file, row, ++number);
    if (!read) continue;
    const auto& [lambda, theta_i, theta_o, phi, value] = *read;
    const std::size_t band = place_of(lambda_m, lambda);
    if (band == bands)
      throw Error::in_file(file.name, fmt::format("a listed wavelength in row {}", number),
                           fmt::format("{}", lambda));
    const auto [place, is_new] = table.places.emplace(Angles{theta_i, theta_o, phi}, table.angles.size());
    if (is_new) {
      // A table with almost as many spectra as rows would be mostly holes.
      if ((table.angles.size() + 1) * bands > 64 * rows.size() + 64 * bands)
        throw Error::in_file(file.name, "the same directions at every wavelength", "different ones at each");
      table.angles.push_back(place->first);
      table.values.resize(table.values.size() + bands, std::numeric_limits<double>::quiet_NaN());
    }
    double& at = table.values[place->second * bands + band];
    if (!std::isnan(at))
      throw Error::in_file(file.name, "one value for each direction and wavelength",
                           fmt::format("a second one in row {}", number));
    at = value;
  }
  return table;
}

/// Returns a string, or the strings of an array.
std::vector<std::string> strings_of(const Json& metadata, const char* key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) return {};
  if (found->is_string()) return {found->get<std::string>()};
  std::vector<std::string> strings;
  if (found->is_array())
    for (const Json& item : *found)
      if (item.is_string()) strings.push_back(item.get<std::string>());
  return strings;
}

std::string text_of(const Json& metadata, const char* key) {
  return fmt::format("{}", fmt::join(strings_of(metadata, key), ", "));
}

void describe(const Json& document, Findings& findings) {
  findings.format = "OpenMATERIAL 3D look-up table";
  findings.conventions = {
      "Angles in radians, the azimuth relative to the light's: retroreflection at 0, the mirror direction at "
      "180 "
      "degrees.",
      "Isotropic, as the schema has no incident azimuth."};
  const auto metadata = document.find("metadata");
  if (metadata == document.end() || !metadata->is_object()) return;
  findings.description = printable(text_of(*metadata, "name"), kMaxRemark);
  findings.origin = {.licence = text_of(*metadata, "license"),
                     .sources = text_of(*metadata, "sources"),
                     .copyrights = strings_of(*metadata, "copyrights"),
                     .authors = strings_of(*metadata, "authors")};
  for (const auto& [key, word] : {std::pair("license", "Licence"), std::pair("copyrights", "Copyright"),
                                  std::pair("authors", "Authors"), std::pair("sources", "Origin")})
    if (const std::string text = printable(text_of(*metadata, key), kMaxRemark); !text.empty())
      findings.conventions.push_back(fmt::format("{}: {}.", word, text));
}

/// Returns an identifier of the form 8-4-4-4-12 for a text: FNV-1a from two starts.
std::string identifier(std::string_view text) {
  std::array<std::uint64_t, 2> hash{0xcbf29ce484222325, 0x84222325cbf29ce4};
  for (std::uint64_t& h : hash)
    for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:08x}-{:04x}-8{:03x}-8{:03x}-{:012x}", hash[0] >> 32, hash[0] >> 16 & 0xffff,
                     hash[0] & 0xfff, hash[1] >> 52, hash[1] & 0xffffffffffff);
}

}  // namespace

bool looks_like_openmaterial(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string_view::npos || text[first] != '{') return false;
  return text.substr(0, 1 << 20).find("\"lookupTable\"") != std::string_view::npos;
}

SampleFile parse_openmaterial(const FileBytes& file, const OpenOptions& options) {
  const Json document = parse_document(file);
  const Json& brdf = member(file, document, "brdf", Json::value_t::object);
  const auto lambda_m = read_wavelengths(file, member(file, brdf, "wavelengths", Json::value_t::array));
  const SpectrumTable table =
      collect(file, member(file, brdf, "lookupTable", Json::value_t::array), lambda_m);

  // Only whole spectra become samples.
  SampleFile result;
  describe(document, result.findings);
  Samples& samples = result.samples;
  samples.channels = static_cast<int>(lambda_m.size());
  samples.isotropic = true;
  std::uint64_t holes = 0;
  for (std::size_t i = 0; i < table.angles.size(); ++i) {
    const auto spectrum = std::span(table.values).subspan(i * lambda_m.size(), lambda_m.size());
    if (std::any_of(spectrum.begin(), spectrum.end(), [](double v) { return std::isnan(v); })) {
      ++holes;
      continue;
    }
    const auto [theta_i, theta_o, phi] = table.angles[i];
    samples.pairs.push_back({spherical_direction(std::min(theta_i, kHalfPi), 0),
                             spherical_direction(std::min(theta_o, kHalfPi), phi)});
    samples.values.insert(samples.values.end(), spectrum.begin(), spectrum.end());
  }
  // Wavelengths become nanometres, rounded to the digits of a metre's decimal fraction.
  for (const double lambda : lambda_m) result.findings.lambda_nm.push_back(std::round(lambda * 1e15) / 1e6);
  finish_samples(file.name, options, result);
  result.findings.hole_count = holes;
  return result;
}

OpenMaterialText format_openmaterial(const Samples& samples, std::span<const double> lambda_nm,
                                     std::string_view name, const Origin& origin) {
  const std::size_t channels = samples.channels;
  if (!samples.isotropic) throw Error("OpenMATERIAL: expected isotropic samples, found anisotropic ones");
  if (lambda_nm.size() != channels)
    throw Error(fmt::format("OpenMATERIAL: expected {} wavelengths, found {}", channels, lambda_nm.size()));

  // Samples of equal angles are summed, in the order of the columns.
  struct Sum {
    std::vector<double> values;
    std::size_t count = 0;
  };
  std::map<Angles, Sum> sums;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [wi, wo] = samples.pairs[i];
    double turn = std::remainder(phi_of(wo) - phi_of(wi), kTwoPi);
    if (turn < 0) turn += kTwoPi;
    Sum& sum = sums[{std::min(theta_of(wi), kHalfPiOfSchema), std::min(theta_of(wo), kHalfPiOfSchema),
                     std::min(turn, kTwoPiOfSchema)}];
    sum.values.resize(channels);
    for (std::size_t c = 0; c < channels; ++c) sum.values[c] += std::max(samples.at(i)[c], 0.0);
    ++sum.count;
  }

  std::string rows;
  for (std::size_t c = 0; c < channels; ++c)
    for (const auto& [angles, sum] : sums)
      rows += fmt::format("{}[{},{},{},{},{}]", rows.empty() ? "\n" : ",\n", lambda_nm[c] * 1e-9, angles[0],
                          angles[1], angles[2], sum.values[c] / static_cast<double>(sum.count));
  std::string wavelengths;
  for (const double lambda : lambda_nm)
    wavelengths += fmt::format("{}{}", wavelengths.empty() ? "" : ",", lambda * 1e-9);
  const auto quoted = [](const Json& value) {
    return value.dump(-1, ' ', true, Json::error_handler_t::replace);
  };
  const auto said = [&](const auto& value, const Json& otherwise) {
    return quoted(value.empty() ? otherwise : Json(value));
  };
  const Json unknown = "unknown", nobody = {"unknown"};
  std::string text = fmt::format(
      "{{\"$schema\":\"https://raw.githubusercontent.com/asam-ev/OpenMATERIAL-3D/refs/tags/v1.0.0/schemas/"
      "material_brdf_schema.json\",\n\"metadata\":{{\"name\":{},\"uuid\":\"{}\",\"materialVersion\":\"1.0."
      "0\","
      "\"openMaterial3dVersion\":\"1.0.0\",\"copyrights\":{},\"license\":{},\"authors\":{},\"sources\":{}}},"
      "\n"
      "\"brdf\":{{\"wavelengths\":[{}],\n\"lookupTable\":[{}\n]}}}}\n",
      quoted(name), identifier(rows), said(origin.copyrights, nobody), said(origin.licence, unknown),
      said(origin.authors, nobody), said(origin.sources, "converted by burnish"), wavelengths, rows);
  return {.text = std::move(text), .averaged = samples.size() - sums.size()};
}

}  // namespace burnish
