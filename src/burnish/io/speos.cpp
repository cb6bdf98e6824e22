// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <burnish/io/part_choice.h>
#include <burnish/io/sample_file.h>
#include <burnish/io/spectral_table.h>
#include <burnish/io/speos.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/math/written_degrees.h>

namespace burnish {

namespace {

constexpr std::string_view kAnisotropic = "OPTIS - Anisotropic BSDF surface file",
                           kBrdf = "OPTIS - brdf surface file";
constexpr std::size_t kMaxAngles = 4096, kMaxValues = std::size_t{1} << 26;
constexpr double kMaxValue = 1e30;
constexpr double kTrusted = 0.05;  // relative to a reflectance; allows for quadrature and rounding
constexpr double kHorizon = 1e-6;  // a cosine below it counts as the horizon
constexpr double kSameDegree = 1e-6;

/// Values of one incidence over theta and phi in degrees.
struct Block {
  std::vector<double> theta_deg, phi_deg, values;  // [theta][phi]

  friend bool operator==(const Block&, const Block&) = default;
};

/// The content of either kind of file: blocks[channel][rotation][incidence].
struct Content {
  bool holds_f = true;  // f_r; otherwise f_r cos(theta_o)
  std::vector<double> rotations_deg, incidences_deg, lambda_nm;
  std::vector<std::vector<std::vector<Block>>> blocks;
  std::string comment;
  std::string scaling;           // says how the stated reflectances were used
  std::vector<BsdfBlock> parts;  // parts of the file, in its order
  std::size_t chosen = 0;        // the one of these parts that is kept

  bool keeps(std::size_t part) const noexcept { return part == chosen; }
};

/// Returns the next number, which stands on a later line if this one has none left.
double next_number(TextReader& reader, std::string_view what) {
  for (;;) {
    if (const std::string_view word = reader.word(); !word.empty()) {
      if (const auto value = parse_number(word)) return *value;
      reader.fail(fmt::format("a finite number for {}", what), in_quotes(word));
    }
    if (!reader.next_content_line()) reader.fail(fmt::format("a number for {}", what), "the end of the file");
  }
}

/// Passes over the words left in a line, which are no numbers.
void skip_line(TextReader& reader) {
  while (!reader.word().empty()) {
  }
}

std::size_t next_count(TextReader& reader, std::string_view what, std::size_t most) {
  const double value = next_number(reader, what);
  if (!(value >= 1 && value <= static_cast<double>(most) && value == std::floor(value)))
    reader.fail(fmt::format("{} in [1, {}]", what, most), fmt::format("{}", value));
  return static_cast<std::size_t>(value);
}

/// Reads increasing angles in [0, high] degrees.
std::vector<double> next_angles(TextReader& reader, std::string_view what, std::size_t count, double high) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = next_number(reader, what);
    if (!(angle >= 0 && angle <= high + kSameDegree) || (i > 0 && angle <= angles.back()))
      reader.fail(fmt::format("increasing {} in [0, {}] degrees", what, high), fmt::format("{}", angle));
    angles.push_back(angle);
  }
  return angles;
}

/// Mirrors the thetas of transmitted light, which count from 90 to 180 degrees, through the surface.
void mirror_thetas(Block& block) {
  const std::size_t phis = block.phi_deg.size();
  std::reverse(block.theta_deg.begin(), block.theta_deg.end());
  for (double& theta : block.theta_deg) theta = 180 - theta;
  std::vector<double> values;
  values.reserve(block.values.size());
  for (std::size_t t = block.theta_deg.size(); t-- > 0;)
    values.insert(values.end(), block.values.begin() + static_cast<std::ptrdiff_t>(t * phis),
                  block.values.begin() + static_cast<std::ptrdiff_t>((t + 1) * phis));
  block.values = std::move(values);
}

/// Reads a block. Thetas of transmission count from 90 to 180 degrees or from 0 to 90.
Block next_block(TextReader& reader, BsdfPart part) {
  const std::size_t thetas = next_count(reader, "the number of theta", kMaxAngles);
  const std::size_t phis = next_count(reader, "the number of phi", kMaxAngles);
  if (thetas * phis * 2 > reader.remaining())
    reader.fail(fmt::format("{} x {} values", thetas, phis), fmt::format("{} bytes", reader.remaining()));
  Block block;
  block.phi_deg = next_angles(reader, "phi", phis, 360);
  double least = 0, most = 90;
  for (std::size_t t = 0; t < thetas; ++t) {
    const double theta = next_number(reader, "theta");
    if (t == 0 && is_transmission(part) && theta >= 90 - kSameDegree) least = 90, most = 180;
    if (!(theta >= least - kSameDegree && theta <= most + kSameDegree) ||
        (t > 0 && theta <= block.theta_deg.back()))
      reader.fail(fmt::format("increasing theta in [{}, {}] degrees", least, most), fmt::format("{}", theta));
    block.theta_deg.push_back(theta);
    for (std::size_t p = 0; p < phis; ++p) {
      const double value = next_number(reader, "a value");
      if (!(std::abs(value) < kMaxValue))
        reader.fail(fmt::format("a value below {:g}", kMaxValue), fmt::format("{}", value));
      block.values.push_back(value);
    }
  }
  if (least > 0) mirror_thetas(block);
  return block;
}

/// Reads the lines that both kinds begin with, up to the type of the values.
Content read_preamble(TextReader& reader, const std::string& file, const OpenOptions& options,
                      bool anisotropic) {
  Content content;
  const auto line = [&](const char* what) {
    if (!reader.next_line()) reader.fail(what, "the end of the file");
    return trimmed(reader.line());
  };
  line("a header");
  if (const std::string_view mode = line("the mode"); mode != "0")
    reader.fail("text mode, 0", in_quotes(mode));
  content.comment = printable(line("a comment"), 160);
  line("the length of a description");
  const std::size_t length = reader.count("the length of a description", 0, std::size_t{1} << 20);
  std::size_t read = 0;
  do read += line("a description").size() + 1;
  while (read < length);
  skip_line(reader);
  if (anisotropic)
    for (int k = 0; k < 3; ++k) next_number(reader, "the anisotropy vector");
  const double reflection = next_number(reader, "the flag of reflection");
  const double transmission = next_number(reader, "the flag of transmission");
  for (const double given : {reflection, transmission})
    if ((given != 0 && given != 1) || reflection + transmission == 0)
      reader.fail("reflection and transmission, 1 0, 0 1 or 1 1",
                  fmt::format("{} {}", reflection, transmission));
  if (reflection == 1) content.parts.push_back({BsdfPart::reflection_front, {}});
  if (transmission == 1) content.parts.push_back({BsdfPart::transmission_front, {}});
  content.chosen = choose_block(file, content.parts, options);
  content.holds_f = next_number(reader, "the type of the values") != 0;
  return content;
}

/// Returns the integrals over theta in [a, b] of sin(theta) times a line that is 1 at a and 0 at b, and times the
/// other line. With `cosine`, sin(theta) cos(theta) takes the place of sin(theta). The integrals are exact, so that
/// a coarse table of constant values integrates to its true share.
std::pair<double, double> line_integrals(double a, double b, bool cosine) noexcept {
  // sin(theta) cos(theta) is sin(2 theta) / 2. With u = w theta, the integrals are those of sin(u) and of u sin(u).
  const double w = cosine ? 2 : 1, ua = w * a, ub = w * b;
  const double whole = std::cos(ua) - std::cos(ub);
  const double first = (std::sin(ub) - ub * std::cos(ub)) - (std::sin(ua) - ua * std::cos(ua));
  const double scale = (cosine ? 0.5 : 1) / w, rising = (first - ua * whole) / (ub - ua);
  return {scale * (whole - rising), scale * rising};
}

/// Returns the integral of a block over the hemisphere, linear between angles. Values are multiplied by the cosine
/// unless they contain it.
double integral(const Block& block, bool holds_f) noexcept {
  const std::size_t phis = block.phi_deg.size();
  // Each azimuth stands for a share of the circle.
  const auto around = [&](std::size_t t) {
    double sum = 0;
    for (std::size_t p = 1; p < phis; ++p)
      sum += radians(block.phi_deg[p] - block.phi_deg[p - 1]) *
             (block.values[t * phis + p - 1] + block.values[t * phis + p]) / 2;
    return sum;
  };
  double sum = 0;
  for (std::size_t t = 1; t < block.theta_deg.size(); ++t) {
    const auto [low, high] =
        line_integrals(radians(block.theta_deg[t - 1]), radians(block.theta_deg[t]), holds_f);
    sum += low * around(t - 1) + high * around(t);
  }
  return block.phi_deg.back() > 180 + kSameDegree ? sum : 2 * sum;
}

bool trusted(double reflectance, double found) noexcept {
  return std::abs(reflectance - found) <= kTrusted * std::max(reflectance, kTrusted);
}

void scale(Block& block, double factor, const TextReader& reader) {
  for (double& value : block.values) {
    value *= factor;
    if (!(std::abs(value) < kMaxValue))
      reader.fail(fmt::format("reflectances that keep values below {:g}", kMaxValue),
                  fmt::format("{}", value));
  }
}

/// Returns the first of the two nodes around x and the weight of the second. Values are constant beyond the ends.
std::pair<std::size_t, double> place_of(const std::vector<double>& nodes, double x) noexcept {
  if (nodes.size() == 1 || x <= nodes.front()) return {0, 0.0};
  const auto above =
      static_cast<std::size_t>(std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin());
  if (above == nodes.size()) return {nodes.size() - 2, 1.0};
  return {above - 1, (x - nodes[above - 1]) / (nodes[above] - nodes[above - 1])};
}

double value_at(const Block& block, double theta_deg, double phi_deg) noexcept {
  const auto [t, theta_weight] = place_of(block.theta_deg, theta_deg);
  const auto [p, phi_weight] = place_of(block.phi_deg, phi_deg);
  double sum = 0;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const double weight =
        (corner & 1 ? theta_weight : 1 - theta_weight) * (corner & 2 ? phi_weight : 1 - phi_weight);
    if (weight > 0)
      sum += weight * block.values[(t + (corner & 1)) * block.phi_deg.size() + p + (corner >> 1)];
  }
  return sum;
}

/// The numbers of one part that stand in front of the blocks of a `.anisotropicbsdf`.
struct PartHead {
  std::vector<double> rotations_deg, incidences_deg, lambda_nm, shares;
  double measured_deg = 0;  // incidence at which the spectrum was measured
};

void read_part_angles(TextReader& reader, PartHead& head) {
  const std::size_t rotations = next_count(reader, "the number of anisotropy angles", kMaxAngles);
  head.rotations_deg = next_angles(reader, "anisotropy angles", rotations, 360);
  for (std::size_t r = 0; r < rotations; ++r) {
    const std::size_t count = next_count(reader, "the number of incidences", kMaxAngles);
    auto angles = next_angles(reader, "incidences", count, 90);
    if (r > 0 && angles != head.incidences_deg)
      reader.fail("the same incidences for every anisotropy angle", "others");
    head.incidences_deg = std::move(angles);
  }
}

void read_part_spectrum(TextReader& reader, PartHead& head) {
  head.measured_deg = next_number(reader, "the incidence of the spectrum");
  next_number(reader, "the azimuth of the spectrum");
  reader.next_line();  // the spectrum's description
  skip_line(reader);
  for (std::size_t n = next_count(reader, "the number of wavelengths", kMaxFileChannels); n > 0; --n) {
    head.lambda_nm.push_back(next_number(reader, "a wavelength"));
    head.shares.push_back(next_number(reader, "a reflectance or transmittance") / 100);
  }
}

/// Makes one channel for each wavelength of one part's blocks, scaled to the spectrum. A flat spectrum makes a
/// single channel, and blocks that agree with it stay as they are.
void take_spectrum(const TextReader& reader, PartHead head, std::vector<std::vector<Block>> blocks,
                   Content& content) {
  content.rotations_deg = std::move(head.rotations_deg);
  content.incidences_deg = std::move(head.incidences_deg);
  content.lambda_nm = std::move(head.lambda_nm);
  std::vector<double> shares = std::move(head.shares);
  // The blocks have this share at the incidence of the spectrum.
  const auto [first, weight] = place_of(content.incidences_deg, head.measured_deg);
  double found = (1 - weight) * integral(blocks[0][first], content.holds_f);
  if (weight > 0) found += weight * integral(blocks[0][first + 1], content.holds_f);
  const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
  if (!(*least >= 0 && found > 0)) reader.fail("a positive reflectance", fmt::format("{}", found));
  const bool flat = *least == *most, kept = flat && trusted(*least, found);
  content.scaling = fmt::format(
      "The values integrate to {:.4g} % at {} degrees, the file states {:.4g} to {:.4g} %: {}.", 100 * found,
      head.measured_deg, 100 * *least, 100 * *most, kept ? "taken as they are" : "scaled");
  if (flat) {
    shares = {kept ? found : *least};
    if (content.lambda_nm.size() > 1) content.lambda_nm.clear();  // grey; one wavelength alone is kept
  }
  for (const double r : shares) {
    content.blocks.push_back(blocks);
    for (auto& of_rotation : content.blocks.back())
      for (Block& block : of_rotation) scale(block, r / found, reader);
  }
}

/// Reads one block for each rotation and incidence of each part, and the spectra that the blocks are scaled to. Angles
/// of all parts come first, then their spectra, then their blocks.
Content read_anisotropic(TextReader& reader, const std::string& file, const OpenOptions& options) {
  Content content = read_preamble(reader, file, options, true);
  std::vector<PartHead> heads(content.parts.size());
  for (PartHead& head : heads) read_part_angles(reader, head);
  for (PartHead& head : heads) read_part_spectrum(reader, head);
  std::vector<std::vector<Block>> kept;
  for (std::size_t part = 0; part < heads.size(); ++part) {
    std::vector<std::vector<Block>> blocks(heads[part].rotations_deg.size());
    for (auto& of_rotation : blocks)
      for (std::size_t i = 0; i < heads[part].incidences_deg.size(); ++i)
        of_rotation.push_back(next_block(reader, content.parts[part].part));
    if (content.keeps(part)) kept = std::move(blocks);
  }
  take_spectrum(reader, std::move(heads[content.chosen]), std::move(kept), content);
  return content;
}

/// Reads one block for each incidence and wavelength, each with its reflectance. Reflection comes before transmission.
Content read_brdf(TextReader& reader, const std::string& file, const OpenOptions& options) {
  Content content = read_preamble(reader, file, options, false);
  const std::size_t incidences = next_count(reader, "the number of incidences", kMaxAngles);
  const std::size_t bands = next_count(reader, "the number of wavelengths", kMaxFileChannels);
  content.incidences_deg = next_angles(reader, "incidences", incidences, 90);
  for (std::size_t k = 0; k < bands; ++k) content.lambda_nm.push_back(next_number(reader, "a wavelength"));
  content.rotations_deg = {0};
  content.blocks.assign(bands, {{}});
  std::vector<std::vector<double>> factors(bands);
  bool kept = true;
  for (std::size_t part = 0; part < content.parts.size(); ++part)
    for (std::size_t i = 0; i < incidences; ++i)
      for (std::size_t k = 0; k < bands; ++k) {
        const BsdfPart which = content.parts[part].part;
        const double share =
            next_number(reader, is_transmission(which) ? "a transmittance" : "a reflectance") / 100;
        Block block = next_block(reader, which);
        if (!content.keeps(part)) continue;
        const double found = integral(block, content.holds_f);
        content.blocks[k][0].push_back(std::move(block));
        if (!(share >= 0 && (found > 0 || share == 0)))
          reader.fail("a positive reflectance", fmt::format("{}", found));
        kept = kept && trusted(share, found);
        factors[k].push_back(found > 0 ? share / found : 0);
      }
  content.scaling = kept ? "The values integrate to the stated reflectances: taken as they are."
                         : "The values are scaled to the stated reflectances.";
  if (!kept)
    for (std::size_t k = 0; k < bands; ++k)
      for (std::size_t i = 0; i < incidences; ++i) scale(content.blocks[k][0][i], factors[k][i], reader);
  return content;
}

/// Returns the angles of all blocks in degrees. Angles less than kSameDegree apart count as one.
std::vector<double> all_angles(const Content& content, std::vector<double> Block::*angles) {
  std::vector<double> all;
  for (const auto& of_channel : content.blocks)
    for (const auto& of_rotation : of_channel)
      for (const Block& block : of_rotation) {
        const std::vector<double>& own = block.*angles;
        if (std::includes(all.begin(), all.end(), own.begin(), own.end())) continue;
        std::vector<double> both;
        std::set_union(all.begin(), all.end(), own.begin(), own.end(), std::back_inserter(both));
        all = std::move(both);
      }
  const auto same = [](double a, double b) { return b - a < kSameDegree; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

/// A node of the table and the angle in the file that its values come from.
struct AzimuthNode {
  double node_deg, phi_deg;
};

/// Returns the azimuths phi_o - phi_i of the file's phi, whose 0 is the mirror direction.
std::vector<AzimuthNode> azimuth_nodes(const std::vector<double>& phis_deg, bool folded) {
  std::vector<AzimuthNode> nodes;
  for (const double phi : phis_deg) {
    if (!folded && phi >= 360 - kSameDegree && phis_deg.front() < kSameDegree) continue;  // the same as 0
    nodes.push_back({folded ? 180 - phi : std::fmod(phi + 180, 360), phi});
  }
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.node_deg < b.node_deg; });
  return nodes;
}

/// Returns the azimuths of wi for the sample's rotations. Anisotropy angles count from the direction that the
/// light travels to, and wi stands opposite to it.
std::vector<AzimuthNode> rotation_nodes(const std::vector<double>& rotations_deg) {
  std::vector<AzimuthNode> nodes;
  for (const double angle : rotations_deg) nodes.push_back({std::fmod(540 - angle, 360), angle});
  if (nodes.size() > 1 && nodes.back().phi_deg - nodes.front().phi_deg >= 360 - kSameDegree) nodes.pop_back();
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.node_deg < b.node_deg; });
  return nodes;
}

AngleAxis azimuth_axis(const std::vector<AzimuthNode>& nodes, double period) {
  std::vector<double> angles;
  for (const AzimuthNode& node : nodes) angles.push_back(radians(node.node_deg));
  return make_axis(angles, period);
}

AngleAxis polar_axis(const std::vector<double>& thetas_deg) {
  std::vector<double> angles;
  for (const double angle : thetas_deg) angles.push_back(std::min(radians(angle), kHalfPi));
  return make_axis(angles);
}

/// A table, and the counts of its values.
struct CountedTable {
  AngleTable table;
  std::size_t entries = 0, holes = 0, negatives = 0;
  double most_negative = 0;
};

/// Fills every entry from its block. An entry is a hole if its cosine cannot be divided out.
CountedTable make_table(const FileBytes& file, const Content& content) {
  const std::vector<double> thetas = all_angles(content, &Block::theta_deg);
  const std::vector<double> phis = all_angles(content, &Block::phi_deg);
  CountedTable result;
  AngleTable& table = result.table;
  table.folded = phis.back() <= 180 + kSameDegree;
  const std::vector<AzimuthNode> azimuths = azimuth_nodes(phis, table.folded),
                                 rotations = rotation_nodes(content.rotations_deg);
  table.channel_count = content.blocks.size();
  const std::size_t channels = content.blocks.size(), incidences = content.incidences_deg.size();
  result.entries = rotations.size() * incidences * thetas.size() * azimuths.size();
  if (result.entries > kMaxValues / channels)
    throw Error::in_file(file.name, fmt::format("at most {} values at the angles of all blocks", kMaxValues),
                         "more");
  table.axes = {azimuth_axis(rotations, kTwoPi), polar_axis(content.incidences_deg), polar_axis(thetas),
                azimuth_axis(azimuths, table.folded ? 0 : kTwoPi)};
  table.values.reserve(result.entries * channels);
  for (const AzimuthNode& rotation : rotations) {
    const auto r = static_cast<std::size_t>(
        std::find(content.rotations_deg.begin(), content.rotations_deg.end(), rotation.phi_deg) -
        content.rotations_deg.begin());
    for (std::size_t i = 0; i < incidences; ++i)
      for (const double theta : thetas)
        for (const AzimuthNode& azimuth : azimuths) {
          const double cosine = content.holds_f ? 1 : std::cos(radians(theta));
          const bool hole = cosine < kHorizon;
          result.holes += hole;
          for (std::size_t c = 0; c < channels; ++c) {
            const double f = value_at(content.blocks[c][r][i], theta, azimuth.phi_deg) / cosine;
            table.values.push_back(hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(f));
            if (hole || f >= 0) continue;
            ++result.negatives;
            result.most_negative = std::min(result.most_negative, f);
          }
        }
  }
  return result;
}

/// Returns true if all rotations have the same values.
bool rotations_alike(const Content& content) {
  return std::all_of(content.blocks.begin(), content.blocks.end(), [](const auto& of_channel) {
    return std::all_of(of_channel.begin(), of_channel.end(),
                       [&](const auto& r) { return r == of_channel.front(); });
  });
}

/// The three pieces of a part, which stand in a file apart from each other.
struct WrittenPart {
  std::string angles, spectrum, blocks;
};

/// A node of a table as the file has it: its angle in degrees, and its place on the table's axis.
struct FileAngle {
  double angle_deg;
  std::size_t at;
};

/// Returns the angles of an axis in the file's order. A circle ends at 360 degrees, where its first angle comes again.
std::vector<FileAngle> file_angles(const AngleAxis& axis, double (*in_file)(double), bool circle) {
  std::vector<FileAngle> angles;
  for (std::size_t k = 0; k < axis.nodes.size(); ++k)
    angles.push_back({in_file(written_degrees(axis.nodes[k])), k});
  std::ranges::sort(angles, {}, &FileAngle::angle_deg);
  if (circle && angles.front().angle_deg == 0) angles.push_back({360, angles.front().at});
  return angles;
}

std::string joined_angles(const std::vector<FileAngle>& angles) {
  std::string text;
  for (const FileAngle& angle : angles)
    text += fmt::format("{}{}", &angle == angles.data() ? "" : "\t", angle.angle_deg);
  return text;
}

WrittenPart written_part(const AngleTable& table, bool transmits) {
  const auto& axes = table.axes;
  const std::vector<FileAngle> rotations =
      axes[0].nodes.size() == 1 ? std::vector<FileAngle>{{0, 0}, {360, 0}}
                                : file_angles(
                                      axes[0], [](double deg) { return std::fmod(540 - deg, 360); }, true);
  const std::vector<FileAngle> incidences = file_angles(
      axes[1], [](double deg) { return deg; }, false);
  const std::vector<FileAngle> thetas = transmits ? file_angles(
                                                        axes[2], [](double deg) { return 180 - deg; }, false)
                                                  : file_angles(
                                                        axes[2], [](double deg) { return deg; }, false);
  const std::vector<FileAngle> phis =
      table.folded ? file_angles(
                         axes[3], [](double deg) { return 180 - deg; }, false)
                   : file_angles(
                         axes[3], [](double deg) { return std::fmod(deg + 180, 360); }, true);

  WrittenPart part;
  part.angles = fmt::format("{}\n{}\n", rotations.size(), joined_angles(rotations));
  for (std::size_t r = 0; r < rotations.size(); ++r)
    part.angles += fmt::format("{}\n{}\n", incidences.size(), joined_angles(incidences));
  std::optional<double> share;
  for (const FileAngle& rotation : rotations)
    for (const FileAngle& incidence : incidences) {
      Block block;
      for (const FileAngle& theta : thetas) block.theta_deg.push_back(theta.angle_deg);
      for (const FileAngle& phi : phis) block.phi_deg.push_back(phi.angle_deg);
      part.blocks += fmt::format("{} {}\n\t{}\n", thetas.size(), phis.size(), joined_angles(phis));
      for (const FileAngle& theta : thetas) {
        part.blocks += fmt::format("{}", theta.angle_deg);
        for (const FileAngle& phi : phis) {
          const std::size_t entry =
              ((rotation.at * axes[1].nodes.size() + incidence.at) * axes[2].nodes.size() + theta.at) *
                  axes[3].nodes.size() +
              phi.at;
          const float f = std::isnan(table.values[entry]) ? 0 : table.values[entry];
          part.blocks += fmt::format("\t{}", f);
          block.values.push_back(static_cast<double>(f));
        }
        part.blocks += '\n';
      }
      if (share) continue;
      if (transmits) mirror_thetas(block);
      share = std::max(integral(block, true), 0.0);
    }
  part.spectrum = fmt::format("{}\t0\n{}\n2\n380\t{}\n780\t{}\n", incidences.front().angle_deg,
                              transmits ? "Transmission" : "Reflection", 100 * *share, 100 * *share);
  return part;
}

}  // namespace

bool looks_like_speos(std::string_view text) noexcept {
  return text.starts_with(kAnisotropic) || text.starts_with(kBrdf);
}

SpeosFile parse_speos(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  SpeosFile result;
  Findings& findings = result.findings;
  const bool anisotropic = file.text().starts_with(kAnisotropic);
  Content content =
      anisotropic ? read_anisotropic(reader, file.name, options) : read_brdf(reader, file.name, options);
  check_wavelengths(file.name, content.lambda_nm);
  findings.format = anisotropic ? "Speos anisotropic BSDF" : "Speos BRDF";
  findings.description = content.comment;
  note_blocks(content.parts, content.chosen, options, findings);
  for (std::size_t part = 0; part < content.parts.size(); ++part)
    if (!content.keeps(part))
      findings.left_out.push_back(is_transmission(content.parts[part].part) ? "transmission" : "reflection");
  findings.conventions.insert(
      findings.conventions.begin(),
      {findings.transmits() ? "Angles in degrees; the direction straight on has phi = 0."
                            : "Angles in degrees; the mirror direction has phi = 0, retroreflection 180.",
       !content.holds_f       ? "Values contain cos(theta_o): it is divided out."
       : findings.transmits() ? "Values are f_t."
                              : "Values are f_r.",
       content.scaling});

  // Rotations with equal values make the table isotropic.
  if (content.rotations_deg.size() > 1 && rotations_alike(content)) {
    findings.conventions.push_back(
        fmt::format("Taken as isotropic: {} rotations of the sample have the same values.",
                    content.rotations_deg.size()));
    content.rotations_deg.resize(1);
  } else if (content.rotations_deg.size() > 1) {
    findings.conventions.push_back(
        "Anisotropy angles go from the direction that the light travels in to the tangent.");
  }
  AngleTable& table = result.table;
  CountedTable made = make_table(file, content);
  table = std::move(made.table);
  findings.sample_count = made.entries;
  findings.hole_count = made.holes;
  findings.negative_count = made.negatives;
  findings.most_negative = made.most_negative;
  findings.theta_i_min = table.axes[1].nodes.front();
  findings.theta_i_max = table.axes[1].nodes.back();
  findings.theta_o_min = table.axes[2].nodes.front();
  findings.theta_o_max = table.axes[2].nodes.back();

  table = shown_spectrum(file.name, std::move(table), content.lambda_nm, options, findings);
  return result;
}

AngleTable speos_layout(bool isotropic) {
  const auto steps = [](int count, double step_deg) {
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) angles.push_back(radians(step_deg * i));
    return angles;
  };
  AngleTable table;
  table.folded = isotropic;
  std::vector<double> incidences = isotropic ? steps(18, 5) : steps(9, 10);
  if (!isotropic) incidences.push_back(radians(85));
  table.axes = {make_axis(steps(isotropic ? 1 : 24, 15), kTwoPi), make_axis(std::move(incidences)),
                make_axis(steps(37, 2.5)),
                isotropic ? make_axis(steps(37, 5)) : make_axis(steps(36, 10), kTwoPi)};
  return table;
}

bool fits_speos(const AngleTable& table) noexcept {
  const AngleAxis& azimuths = table.axes[3];
  return table.frame == AngleTable::Frame::normal && table.channel_count == 1 && table.isotropic() &&
         table.axes[2].nodes.size() > 1 && azimuths.nodes.size() > 1 &&
         (table.folded ? azimuths.nodes.front() == 0 && azimuths.nodes.back() > kPi - 1e-9 : azimuths.closed);
}

std::string format_speos(const SpeosParts& parts, std::string_view comment) {
  std::vector<WrittenPart> written;
  if (parts.reflection) written.push_back(written_part(*parts.reflection, false));
  if (parts.transmission) written.push_back(written_part(*parts.transmission, true));
  std::string text =
      fmt::format("{} v8.0\n0\n{}\n0\n\n1\t0\t0\n{}\t{}\n1\n", kAnisotropic, printable(comment, 160),
                  parts.reflection ? 1 : 0, parts.transmission ? 1 : 0);
  for (const WrittenPart& part : written) text += part.angles;
  for (const WrittenPart& part : written) text += part.spectrum;
  for (const WrittenPart& part : written) text += part.blocks;
  return text + "End of file\n";
}

}  // namespace burnish
