// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <burnish/io/integra.h>
#include <burnish/io/part_choice.h>
#include <burnish/io/sample_file.h>
#include <burnish/io/spectral_table.h>
#include <burnish/io/stated_totals.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxIntegraAngles = 4096, kMaxIntegraValues = std::size_t{1} << 26;
constexpr double kIntegraHorizon = 1e-6;  // a cosine below it counts as the horizon

/// Reads words from line to line; ";;" begins a comment.
class IntegraWords {
 public:
  explicit IntegraWords(const FileBytes& file) noexcept : reader_(file) {}

  /// Returns the next word in small letters, empty at the end of the file.
  std::string next() {
    for (;;) {
      const std::string_view word = reader_.word();
      if (!word.empty() && !word.starts_with(";;")) return lower_case(word);
      if (!reader_.next_line()) return {};
    }
  }
  double number(std::string_view what) {
    const std::string word = next();
    if (const auto value = parse_number(word)) return *value;
    fail(fmt::format("a finite number for {}", what), word.empty() ? "the end of the file" : in_quotes(word));
  }
  std::size_t count(std::string_view what, std::size_t most) {
    const double value = number(what);
    if (!(value >= 1 && value <= static_cast<double>(most) && value == std::floor(value)))
      fail(fmt::format("{} in [1, {}]", what, most), fmt::format("{}", value));
    return static_cast<std::size_t>(value);
  }
  std::size_t remaining() const noexcept { return reader_.remaining() + reader_.line().size(); }
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    reader_.fail(expected, found);
  }

 private:
  TextReader reader_;
};

/// The lines in front of the values; angles in degrees.
struct IntegraHeader {
  std::string symmetry, colour, quantity, mode;
  std::size_t channels = 0;
  std::vector<double> psi, sigma, sigmat, phi, theta;

  bool relative() const noexcept { return mode == "relative"; }
};

/// Reads increasing angles in [0, most] degrees.
std::vector<double> read_angle_list(IntegraWords& words, const std::string& name, double most) {
  const std::size_t count = words.count("the number of " + name, kMaxIntegraAngles);
  std::vector<double> angles;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = words.number(name);
    if (!(angle >= 0 && angle <= most) || (k > 0 && angle <= angles.back()))
      words.fail(fmt::format("increasing {} in [0, {}] degrees", name, most), fmt::format("{}", angle));
    angles.push_back(angle);
  }
  return angles;
}

/// Returns the place of a channel's keyword; nothing for another word.
std::optional<std::size_t> channel_of(const std::string& word) noexcept {
  if (word == "bw" || word == "wl" || word == "red") return 0;
  if (word == "gre" || word == "green") return 1;
  if (word == "blu" || word == "blue") return 2;
  return std::nullopt;
}

std::string one_of_words(IntegraWords& words, const std::string& keyword,
                         std::initializer_list<std::string_view> known) {
  std::string word = words.next();
  if (std::ranges::find(known, word) == known.end())
    words.fail(fmt::format("{} {}", keyword, fmt::join(known, ", ")), in_quotes(word));
  return word;
}

/// Reads keywords up to the first channel's, and returns it.
std::string read_integra_header(IntegraWords& words, IntegraHeader& header) {
  for (std::string word = words.next();; word = words.next()) {
    if (word.empty()) words.fail("a channel's values", "the end of the file");
    if (word == "source") {
      words.next();
    } else if (word == "typesym") {
      header.symmetry =
          one_of_words(words, "TypeSym", {"axisymmetrical", "planesymmetrical", "asymmetrical"});
    } else if (word == "4d" && header.symmetry == "asymmetrical") {
      continue;
    } else if (word == "typecolormodel") {
      header.colour = one_of_words(words, "TypeColorModel", {"rgb", "bw", "spectral"});
      header.channels = header.colour == "rgb"  ? 3
                        : header.colour == "bw" ? 1
                                                : words.count("the number of wavelengths", kMaxFileChannels);
    } else if (word == "typedata") {
      header.quantity = one_of_words(words, "TypeData", {"luminance", "intensity"});
      header.mode = one_of_words(words, "TypeData", {"absolute", "relative"});
    } else if (word == "psi") {
      header.psi = read_angle_list(words, word, 360);
    } else if (word == "sigma") {
      header.sigma = read_angle_list(words, word, 90);
    } else if (word == "sigmat") {
      // These are as many as sigma, without a count.
      for (std::size_t k = 0; k < header.sigma.size(); ++k) {
        header.sigmat.push_back(words.number(word));
        if (!(header.sigmat.back() >= 0 && header.sigmat.back() <= 90))
          words.fail("sigmat in [0, 90] degrees", fmt::format("{}", header.sigmat.back()));
      }
    } else if (word == "phi") {
      header.phi = read_angle_list(words, word, 360);
    } else if (word == "theta") {
      header.theta = read_angle_list(words, word, 180);
    } else if (channel_of(word)) {
      return word;
    } else {
      words.fail("a keyword of the header", in_quotes(word));
    }
  }
}

void check_integra_header(const IntegraWords& words, IntegraHeader& header) {
  const auto need = [&](bool present, const char* keyword) {
    if (!present) words.fail(fmt::format("the keyword {}", keyword), "none");
  };
  need(!header.symmetry.empty(), "TypeSym");
  need(header.channels > 0, "TypeColorModel");
  need(!header.mode.empty(), "TypeData");
  need(!header.sigma.empty(), "sigma");
  need(!header.phi.empty(), "phi");
  need(!header.theta.empty(), "theta");
  if (header.psi.empty()) header.psi = {0};
  if (header.symmetry == "planesymmetrical" && header.phi.back() > 180)
    words.fail("phi in [0, 180] degrees with PlaneSymmetrical", fmt::format("{}", header.phi.back()));
}

/// Returns the axis of azimuths in degrees, without 360 beside 0. `kept` counts the nodes that stay.
AngleAxis azimuths_of(const std::vector<double>& angles_deg, bool folded, std::size_t& kept) {
  kept = angles_deg.size();
  if (!folded && kept > 1 && angles_deg.front() == 0 && angles_deg.back() == 360) --kept;
  std::vector<double> nodes;
  for (std::size_t k = 0; k < kept; ++k) nodes.push_back(radians(angles_deg[k]));
  return make_axis(std::move(nodes), folded ? 0 : kTwoPi);
}

AngleAxis plain_axis(const std::vector<double>& angles_deg) {
  std::vector<double> nodes;
  for (const double angle : angles_deg) nodes.push_back(radians(angle));
  return make_axis(std::move(nodes));
}

/// A table whose values are being read, and what stands in the file beside them.
struct IntegraValues {
  AngleTable table;
  std::vector<double> kbdf;  ///< [psi][sigma][channel]
  bool has_kbdf = false;
  std::vector<double> lambda_nm;
  std::size_t psi = 0, phi = 0;  ///< nodes that stay of the file's
};

/// Reads the values of one channel, after its keyword.
void read_integra_channel(IntegraWords& words, const IntegraHeader& header, std::size_t channel,
                          IntegraValues& values) {
  AngleTable& table = values.table;
  const std::size_t incidences = header.sigma.size(), channels = header.channels;
  std::string word = words.next();
  if (word == "kbdf") {
    values.has_kbdf = true;
    for (std::size_t b = 0; b < header.psi.size() * incidences; ++b) {
      const double kbdf = words.number("kbdf");
      if (!(kbdf >= 0)) words.fail("kbdf of 0 or more", fmt::format("{}", kbdf));
      if (b / incidences < values.psi) values.kbdf[b * channels + channel] = kbdf;
    }
    word = words.next();
  }
  if (word != "def") words.fail("def", in_quotes(word));
  for (std::size_t p = 0; p < header.psi.size(); ++p)
    for (std::size_t s = 0; s < incidences; ++s)
      for (std::size_t a = 0; a < header.phi.size(); ++a)
        for (std::size_t t = 0; t < header.theta.size(); ++t) {
          const double value = words.number("a value");
          if (std::abs(value) > 1e30) words.fail("a value below 1e30", fmt::format("{}", value));
          if (p >= values.psi || a >= values.phi) continue;
          const std::size_t entry = ((p * incidences + s) * values.phi + a) * header.theta.size() + t;
          double f = value / kPi;
          if (header.quantity == "intensity") {
            const double cosine = node_directions(table, {p, s, a, t}).wo.z;
            f = cosine < kIntegraHorizon ? std::numeric_limits<double>::quiet_NaN() : value / cosine;
          }
          if (!header.relative()) f *= values.kbdf[(p * incidences + s) * channels + channel];
          table.values[entry * channels + channel] = static_cast<float>(f);
        }
}

bool ends_in(std::string_view name, std::string_view ending) {
  return name.size() >= ending.size() && lower_case(name.substr(name.size() - ending.size())) == ending;
}

}  // namespace

bool looks_like_integra(std::string_view text) noexcept {
  constexpr std::string_view kKeyword = "typesym";
  text = text.substr(0, 65536);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    if (line.size() > kKeyword.size() && (line[kKeyword.size()] == ' ' || line[kKeyword.size()] == '\t') &&
        lower_case(line.substr(0, kKeyword.size())) == kKeyword)
      return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

IntegraFile parse_integra(const FileBytes& file, const OpenOptions& options) {
  IntegraWords words(file);
  IntegraHeader header;
  std::string keyword = read_integra_header(words, header);
  check_integra_header(words, header);
  const bool folded = header.symmetry == "planesymmetrical";

  IntegraValues values;
  AngleTable& table = values.table;
  table.frame = AngleTable::Frame::specular;
  table.folded = folded;
  table.channel_count = header.channels;
  table.axes = {azimuths_of(header.psi, false, values.psi), plain_axis(header.sigma),
                azimuths_of(header.phi, folded, values.phi), plain_axis(header.theta)};
  for (const double angle : header.sigmat) table.centre_theta.push_back(radians(angle));
  const std::size_t stored =
      header.psi.size() * header.sigma.size() * header.phi.size() * header.theta.size();  // at most 2^48
  // A value takes at least a digit and a separator.
  if (stored > kMaxIntegraValues / header.channels || 2 * stored * header.channels > words.remaining() + 1)
    words.fail(fmt::format("{} values of {} channels", stored, header.channels),
               fmt::format("{} bytes to the end", words.remaining()));
  table.values.resize(entry_count(table) * header.channels);
  values.kbdf.assign(values.psi * header.sigma.size() * header.channels, 1.0);

  std::vector<bool> seen(header.channels);
  for (; !keyword.empty(); keyword = words.next()) {
    if (keyword == "enddef") continue;
    auto channel = channel_of(keyword);
    if (!channel) words.fail("a channel's keyword", in_quotes(keyword));
    if (keyword == "wl") {
      *channel = values.lambda_nm.size();
      values.lambda_nm.push_back(words.number("a wavelength"));
    }
    if (*channel >= header.channels || seen[*channel] || (keyword == "wl") != (header.colour == "spectral"))
      words.fail(fmt::format("{} channels of TypeColorModel {}", header.channels, header.colour),
                 in_quotes(keyword) + (*channel < header.channels && seen[*channel] ? " again" : ""));
    seen[*channel] = true;
    read_integra_channel(words, header, *channel, values);
  }
  if (std::ranges::find(seen, false) != seen.end())
    words.fail(fmt::format("{} channels", header.channels),
               fmt::format("{}", std::ranges::count(seen, true)));
  check_wavelengths(file.name, values.lambda_nm);

  IntegraFile result;
  Findings& findings = result.findings;
  const bool transmits = ends_in(file.name, ".ddt") || !header.sigmat.empty();
  const BsdfBlock only{transmits ? BsdfPart::transmission_front : BsdfPart::reflection_front, {}};
  findings.format = transmits ? "Integra DDT" : "Integra DDR";
  findings.conventions = {
      fmt::format("phi and theta are around and from {}, phi 0 to the normal; linear between them.",
                  !transmits              ? "the mirror direction"
                  : header.sigmat.empty() ? "the direction straight on"
                                          : "the refracted direction sigmat"),
      fmt::format("{} {}: values are {}{}.", header.quantity == "luminance" ? "Luminance" : "Intensity",
                  header.mode, header.quantity == "luminance" ? "pi f" : "f cos(theta_o)",
                  !values.has_kbdf    ? ""
                  : header.relative() ? ", scaled"
                                      : " over kbdf"),
      table.isotropic() ? "One psi: isotropic." : "psi is phi_i."};
  if (folded) findings.conventions.push_back("Symmetric about the plane of incidence.");
  note_table(table, findings);
  if (header.relative() && values.has_kbdf) scale_channels_to_totals(table, values.kbdf, findings);
  note_blocks({&only, 1}, choose_block(file.name, {&only, 1}, options), options, findings);
  result.table = shown_spectrum(file.name, std::move(table), values.lambda_nm, options, findings);
  return result;
}

}  // namespace burnish
