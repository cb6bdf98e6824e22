// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/io/part_choice.h>
#include <burnish/io/sample_file.h>
#include <burnish/io/spectral_table.h>
#include <burnish/io/ssdd.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/math/luminance.h>
#include <burnish/math/rec709_d65.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

namespace {

constexpr double kMostSsddValue = 1e30;  // colours made linear stay floats
constexpr std::size_t kMaxSsddAngles = 65536, kMaxSsddValues = std::size_t{1} << 26;

/// Lines and numbers of a file that is text up to DATA, and text or floats after it.
class SsddReader {
 public:
  explicit SsddReader(const FileBytes& file) noexcept : bytes_(file), text_(file.text()) {}

  /// Moves to the next line that is neither blank nor a comment; returns false at the end of the file.
  bool next_line() {
    while (bytes_.remaining() > 0) {
      const std::string_view rest = text_.substr(bytes_.offset());
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      line_at_ = bytes_.offset();
      bytes_.seek(bytes_.offset() + std::min(end + 1, rest.size()));
      line_ = trimmed_end(rest.substr(0, end));
      if (!trimmed(line_).empty() && !trimmed(line_).starts_with('#')) return true;
    }
    line_ = {};
    return false;
  }
  /// Returns the next word of the line, empty at its end or at a comment.
  std::string_view word() {
    const std::size_t begin = std::min(line_.find_first_not_of(" \t"), line_.size());
    line_.remove_prefix(begin);
    if (line_.starts_with('#')) line_ = {};
    const std::string_view found = line_.substr(0, line_.find_first_of(" \t"));
    line_.remove_prefix(found.size());
    return found;
  }
  std::string_view rest_of_line() const { return trimmed(line_); }
  std::uint64_t remaining() const noexcept { return bytes_.remaining(); }
  std::span<const std::byte> take(std::uint64_t count) { return bytes_.take(count, "binary values"); }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) {
    bytes_.seek(line_at_);
    bytes_.fail(expected, found);
  }

 private:
  static std::string_view trimmed_end(std::string_view line) noexcept {
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }

  ByteReader bytes_;
  std::string_view text_, line_;
  std::uint64_t line_at_ = 0;
};

enum class SsddType { brdf, btdf, specular_reflectance, specular_transmittance };
constexpr std::string_view kSsddTypes[] = {"brdf", "btdf", "specular_reflectance", "specular_transmittance"};
enum class SsddColour { monochrome, rgb, xyz, spectrum };
constexpr std::string_view kSsddColours[] = {"monochrome", "rgb", "xyz", "spectrum"};
enum class SsddParams { spherical, specular, half_difference, distorted };
constexpr std::string_view kSsddParams[] = {"spherical_coordinate_system", "specular_coordinate_system",
                                            "half_difference_coordinate_system",
                                            "distorted_spherical_coordinate_system"};

/// Meta-data and values of one block; angles in degrees.
struct SsddBlock {
  SsddType type = SsddType::brdf;
  std::optional<SsddColour> colour;
  std::optional<SsddParams> params;
  bool bilateral = false, reciprocal = false;
  std::vector<double> lambda_nm;
  std::array<std::vector<double>, 5> lists;
  std::string name;
  std::vector<float> values;  ///< [param 3][param 2][param 1][param 0][channel]

  bool is_function() const noexcept { return type == SsddType::brdf || type == SsddType::btdf; }
  std::size_t channels() const noexcept {
    if (colour == SsddColour::monochrome) return 1;
    return colour == SsddColour::spectrum ? lambda_nm.size() : 3;
  }
};

template <class Choice, std::size_t n>
Choice one_of_names(SsddReader& reader, const std::string_view (&names)[n]) {
  const std::string_view word = reader.word();
  for (std::size_t k = 0; k < n; ++k)
    if (word == names[k]) return static_cast<Choice>(k);
  reader.fail(fmt::format("one of {}", fmt::join(names, ", ")), in_quotes(word));
}

std::vector<double> read_number_list(SsddReader& reader, std::string_view what, double low, double high) {
  std::vector<double> numbers;
  for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
    const auto number = parse_number(word);
    if (!number || !(*number >= low && *number <= high))
      reader.fail(fmt::format("numbers in [{}, {}] for {}", low, high, what), in_quotes(word));
    if (numbers.size() == kMaxSsddAngles)
      reader.fail(fmt::format("at most {} numbers for {}", kMaxSsddAngles, what), "more");
    numbers.push_back(*number);
  }
  return numbers;
}

void check_rising(SsddReader& reader, const std::vector<double>& numbers, std::string_view what) {
  for (std::size_t k = 1; k < numbers.size(); ++k)
    if (numbers[k] <= numbers[k - 1])
      reader.fail(fmt::format("rising numbers for {}", what),
                  fmt::format("{} after {}", numbers[k], numbers[k - 1]));
}

/// Checks that a block's meta-data is whole, and fills in what may be left out.
void complete_block(SsddReader& reader, SsddBlock& block) {
  const auto need = [&](bool present, std::string_view entry) {
    if (!present) reader.fail(fmt::format("the entry {} before DATA", entry), "none");
  };
  need(block.colour.has_value(), "COLOR_MODEL");
  need(block.colour != SsddColour::spectrum || !block.lambda_nm.empty(), "WAVELENGTH_LIST");
  if (block.lambda_nm.size() > kMaxFileChannels)
    reader.fail(fmt::format("at most {} wavelengths", kMaxFileChannels), "more");
  need(!block.lists[0].empty(), "PARAM0_LIST");
  if (block.lists[1].empty()) block.lists[1] = {0};
  if (!block.is_function()) {
    block.lists[2] = block.lists[3] = {0};
    return;
  }
  need(block.params.has_value(), "PARAM_TYPE");
  need(!block.lists[2].empty(), "PARAM2_LIST");
  need(!block.lists[3].empty(), "PARAM3_LIST");
  if (!block.lists[4].empty() && block.lists[4].size() != block.lists[0].size())
    reader.fail(fmt::format("{} numbers for PARAM4_LIST", block.lists[0].size()),
                fmt::format("{}", block.lists[4].size()));
  if (block.reciprocal && block.params != SsddParams::half_difference)
    reader.fail("REDUCTION_TYPE reciprocity with half_difference_coordinate_system alone",
                std::string(kSsddParams[static_cast<std::size_t>(*block.params)]));
  const double most = (block.bilateral ? 180.0 : 360.0) / (block.reciprocal ? 2 : 1);
  if (block.lists[3].back() > most)
    reader.fail(fmt::format("PARAM3_LIST in [0, {}] degrees with this REDUCTION_TYPE", most),
                fmt::format("{}", block.lists[3].back()));
  if (*block.params != SsddParams::specular && block.lists[2].back() > 90)
    reader.fail("PARAM2_LIST in [0, 90] degrees", fmt::format("{}", block.lists[2].back()));
}

void read_ssdd_values(SsddReader& reader, SsddBlock& block, bool binary) {
  std::size_t count = block.channels();
  for (std::size_t k = 0; k < 4; ++k) {
    count *= block.lists[k].size();
    if (count > kMaxSsddValues) reader.fail(fmt::format("at most {} values", kMaxSsddValues), "more");
  }
  // A value takes four bytes, in text at least a digit and a separator.
  if (count * (binary ? 4 : 2) > reader.remaining() + 1)
    reader.fail(fmt::format("{} values", count), fmt::format("{} bytes to the end", reader.remaining()));
  block.values.reserve(count);
  if (binary) {
    const auto bytes = reader.take(count * sizeof(float));
    block.values.resize(count);
    std::memcpy(block.values.data(), bytes.data(), bytes.size());
    for (const float value : block.values)
      if (!(std::abs(value) <= kMostSsddValue))
        reader.fail(fmt::format("values up to {:g}", kMostSsddValue), fmt::format("{:g}", value));
    return;
  }
  while (block.values.size() < count) {
    if (!reader.next_line())
      reader.fail(fmt::format("{} values", count),
                  fmt::format("{} at the end of the file", block.values.size()));
    for (std::size_t c = 0; c < block.channels(); ++c) {
      const std::string_view word = reader.word();
      const auto value = parse_number(word);
      if (!value || !(std::abs(*value) <= kMostSsddValue))
        reader.fail(fmt::format("a line of {} values up to {:g}", block.channels(), kMostSsddValue),
                    word.empty() ? "fewer" : in_quotes(word));
      block.values.push_back(static_cast<float>(*value));
    }
    if (const std::string_view word = reader.word(); !word.empty())
      reader.fail(fmt::format("a line of {} values", block.channels()), in_quotes(word) + " behind them");
  }
}

/// Reads the entries of a block after DATA_TYPE, and its values.
void read_ssdd_block(SsddReader& reader, SsddBlock& block) {
  block.type = one_of_names<SsddType>(reader, kSsddTypes);
  constexpr std::array kMost{90.0, 360.0, 180.0, 360.0, 90.0};
  for (;;) {
    if (!reader.next_line()) reader.fail("the entry DATA", "the end of the file");
    const std::string entry(reader.word());
    if (entry == "COLOR_MODEL") {
      block.colour = one_of_names<SsddColour>(reader, kSsddColours);
    } else if (entry == "WAVELENGTH_LIST") {
      block.lambda_nm = read_number_list(reader, entry, 0, 1e6);
    } else if (entry == "PARAM_TYPE") {
      block.params = one_of_names<SsddParams>(reader, kSsddParams);
    } else if (entry == "REDUCTION_TYPE") {
      for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
        if (word != "bilateral_symmetry" && word != "reciprocity")
          reader.fail("bilateral_symmetry or reciprocity", in_quotes(word));
        (word == "reciprocity" ? block.reciprocal : block.bilateral) = true;
      }
    } else if (entry.size() == 11 && entry.starts_with("PARAM") && entry.ends_with("_LIST") &&
               entry[5] >= '0' && entry[5] <= '4') {
      const auto k = static_cast<std::size_t>(entry[5] - '0');
      block.lists[k] = read_number_list(reader, entry, k == 4 ? -90 : 0, kMost[k]);
      if (k < 4) check_rising(reader, block.lists[k], entry);
    } else if (entry == "NAME") {
      block.name = printable(reader.rest_of_line(), 200);
    } else if (entry == "DATA") {
      const std::string_view mode = reader.word();
      if (mode != "ascii" && mode != "binary") reader.fail("DATA ascii or binary", in_quotes(mode));
      const bool binary = mode == "binary";
      complete_block(reader, block);
      return read_ssdd_values(reader, block, binary);
    }
    // Other entries say who measured, when and how.
  }
}

/// Returns nodes in radians, the first `count` of the list.
std::vector<double> nodes_of(const std::vector<double>& list_deg, std::size_t count) {
  std::vector<double> nodes;
  for (std::size_t k = 0; k < count; ++k) nodes.push_back(radians(list_deg[k]));
  return nodes;
}

/// Returns the number of azimuths without the last where it is the first again, `turn` degrees on.
std::size_t azimuth_count(const std::vector<double>& list_deg, double turn) {
  const bool again = list_deg.size() > 1 && list_deg.front() == 0 && list_deg.back() == turn;
  return list_deg.size() - (again ? 1 : 0);
}

/// Puts a block's values in the order of a table whose axes are the parameters 1, 0, then `third` and `fourth`.
/// Colours become linear Rec. 709.
void arrange_values(const SsddBlock& block, std::size_t third, std::size_t fourth, AngleTable& table) {
  const auto& l = block.lists;
  const std::size_t channels = block.channels();
  table.channel_count = channels;
  table.values.reserve(entry_count(table) * channels);
  for (std::size_t entry = 0; entry < entry_count(table); ++entry) {
    const auto node = node_of_entry(table, entry);
    std::array<std::size_t, 4> at{};
    at[1] = node[0], at[0] = node[1], at[third] = node[2], at[fourth] = node[3];
    const std::size_t index = at[0] + l[0].size() * (at[1] + l[1].size() * (at[2] + l[2].size() * at[3]));
    const float* value = &block.values[index * channels];
    if (block.colour != SsddColour::xyz) {
      table.values.insert(table.values.end(), value, value + channels);
      continue;
    }
    for (const double v : rec709_of_d65(
             {static_cast<double>(value[0]), static_cast<double>(value[1]), static_cast<double>(value[2])}))
      table.values.push_back(static_cast<float>(v));
  }
}

/// Returns the polar angles of the direction in the place of the mirror direction; empty without offsets.
std::vector<double> offset_centres(const SsddBlock& block) {
  std::vector<double> centres;
  for (std::size_t k = 0; k < block.lists[4].size(); ++k)
    centres.push_back(radians(std::clamp(block.lists[0][k] + block.lists[4][k], 0.0, 90.0)));
  return centres;
}

/// Returns the table of a block: axes of the parameters 1 and 0 (the light's), 2 and 3. Specular coordinates have the
/// azimuth before the angle from the mirror direction.
AngleTable table_of(const SsddBlock& block) {
  AngleTable table;
  const bool specular = block.params == SsddParams::specular;
  table.frame = specular ? AngleTable::Frame::specular : AngleTable::Frame::normal;
  table.folded = block.bilateral;
  const double turn = block.reciprocal ? 180 : 360;
  const std::size_t azimuths = block.bilateral ? block.lists[3].size() : azimuth_count(block.lists[3], turn);
  const AngleAxis azimuth =
      make_axis(nodes_of(block.lists[3], azimuths), block.bilateral ? 0 : radians(turn));
  const AngleAxis polar = make_axis(nodes_of(block.lists[2], block.lists[2].size()));
  table.axes = {make_axis(nodes_of(block.lists[1], azimuth_count(block.lists[1], 360)), kTwoPi),
                make_axis(nodes_of(block.lists[0], block.lists[0].size())), specular ? azimuth : polar,
                specular ? polar : azimuth};
  if (specular || block.params == SsddParams::distorted) table.centre_theta = offset_centres(block);
  arrange_values(block, specular ? 3 : 2, specular ? 2 : 3, table);
  return table;
}

/// Returns the indices and the weight of the second of the nodes next to an angle; the ends' values go on beyond them.
AxisNeighbours nodes_near(const AngleAxis& axis, double angle) noexcept {
  if (axis.period == 0) return neighbours(axis, std::clamp(angle, axis.nodes.front(), axis.nodes.back()));
  AxisNeighbours near = neighbours(axis, angle);
  if (!near.inside) {
    // In a gap of the circle the nearer end counts.
    const auto distance = [&](double node) { return std::abs(std::remainder(angle - node, axis.period)); };
    const std::size_t last = axis.nodes.size() - 1;
    near.index.fill(distance(axis.nodes[0]) <= distance(axis.nodes[last]) ? 0 : last);
    near.fraction = 0;
  }
  return near;
}

/// Interpolates a table at its four parameters.
void interpolate(const AngleTable& table, const std::array<double, 4>& angles, std::span<double> f) noexcept {
  std::array<AxisNeighbours, 4> near;
  for (std::size_t k = 0; k < 4; ++k) near[k] = nodes_near(table.axes[k], angles[k]);
  std::ranges::fill(f, 0.0);
  for (std::size_t corner = 0; corner < 16; ++corner) {
    double weight = 1;
    std::size_t index = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool second = corner >> k & 1;
      weight *= second ? near[k].fraction : 1 - near[k].fraction;
      index = index * table.axes[k].nodes.size() + near[k].index[second];
    }
    if (weight == 0) continue;
    for (std::size_t c = 0; c < f.size(); ++c)
      f[c] += weight * static_cast<double>(table.values[index * f.size() + c]);
  }
}

/// A point of the unit disk whose radius is the polar angle over 90 degrees.
struct DiskPlace {
  double x, y;
};

DiskPlace disk_place(double theta, double phi) noexcept {
  const double r = theta / kHalfPi;
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Returns polar angle and azimuth of the distorted coordinates of wo. A disk around the normal is moved, so that its
/// centre is the mirror direction and its border stays: place = distorted + (1 - |distorted|) centre.
std::array<double, 2> distorted_angles(Vec3 wo, double centre_theta, double centre_phi) noexcept {
  // At the horizon the mirror direction lies on the border, where the coordinates end.
  constexpr double kMostCentre = 1 - 1e-9;
  const DiskPlace at = disk_place(theta_of(wo), phi_of(wo)),
                  centre = disk_place(std::min(centre_theta, kMostCentre * kHalfPi), centre_phi);
  const double dx = at.x - centre.x, dy = at.y - centre.y;
  // |distorted| = r solves |at - (1 - r) centre| = r, the positive root of a r^2 + b r + c = 0.
  const double a = 1 - (centre.x * centre.x + centre.y * centre.y), b = -2 * (dx * centre.x + dy * centre.y),
               c = -(dx * dx + dy * dy);
  const double r = (-b + std::sqrt(std::max(b * b - 4 * a * c, 0.0))) / (2 * a);
  return {r * kHalfPi, std::atan2(dy + r * centre.y, dx + r * centre.x)};
}

/// A block whose coordinates are no table's, as a function.
struct SsddFunction {
  AngleTable table;
  SsddParams params;
  bool bilateral, reciprocal;

  double fold(double azimuth) const noexcept {
    if (!bilateral) return azimuth;
    const double folded = std::abs(std::remainder(azimuth, kTwoPi));
    return reciprocal ? std::min(folded, kPi - folded) : folded;
  }
  double centre(double theta_i) const noexcept {
    if (table.centre_theta.empty()) return theta_i;
    const AxisNeighbours near = nodes_near(table.axes[1], theta_i);
    return (1 - near.fraction) * table.centre_theta[near.index[0]] +
           near.fraction * table.centre_theta[near.index[1]];
  }
  std::array<double, 4> angles(Vec3 wi, Vec3 wo) const noexcept {
    if (params == SsddParams::half_difference) {
      const HalfDiff h = to_half_diff(wi, wo);
      return {h.phi_h, h.theta_h, h.theta_d, fold(h.phi_d)};
    }
    const double phi_i = phi_of(wi), theta_i = theta_of(wi);
    // Azimuths of isotropic data count from the light's.
    const double turned = table.isotropic() ? phi_i : 0;
    if (params == SsddParams::spherical) return {phi_i, theta_i, theta_of(wo), fold(phi_of(wo) - turned)};
    const auto [theta, phi] = distorted_angles(wo, centre(theta_i), phi_i + kPi);
    return {phi_i, theta_i, theta, fold(phi - turned)};
  }
};

FunctionBrdf function_of_ssdd(SsddFunction function) {
  const std::size_t channels = function.table.channel_count;
  const bool isotropic = function.table.isotropic();
  const auto shared = std::make_shared<SsddFunction>(std::move(function));
  return {channels, isotropic,
          [shared, channels](std::span<const DirectionPair> pairs, std::span<double> values) {
            for (std::size_t k = 0; k < pairs.size(); ++k)
              interpolate(shared->table, shared->angles(pairs[k].wi, pairs[k].wo),
                          values.subspan(k * channels, channels));
            cut_negatives(values);
          }};
}

/// Returns the stated shares of a specular block at its first azimuth: of a colour the luminance, of a spectrum the
/// mean.
std::vector<DirectShare> direct_shares(const SsddBlock& block) {
  std::vector<DirectShare> shares;
  const std::size_t channels = block.channels();
  for (std::size_t i = 0; i < block.lists[0].size(); ++i) {
    const std::vector<double> values(block.values.begin() + static_cast<std::ptrdiff_t>(i * channels),
                                     block.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * channels));
    double share = 0;
    if (block.colour == SsddColour::rgb)
      share = luminance({values[0], values[1], values[2]});
    else if (block.colour == SsddColour::xyz)
      share = values[1];
    else
      for (const double value : values) share += value / static_cast<double>(channels);
    shares.push_back({radians(block.lists[0][i]), std::clamp(share, 0.0, 1.0)});
  }
  return shares;
}

std::vector<SsddBlock> read_ssdd_blocks(SsddReader& reader) {
  std::vector<SsddBlock> blocks;
  reader.next_line();  // the version
  while (reader.next_line()) {
    const std::string_view entry = reader.word();
    if (entry != "DATA_TYPE") {
      if (!blocks.empty()) reader.fail("the entry DATA_TYPE", in_quotes(entry));
      continue;  // the head of the file
    }
    SsddBlock block;
    read_ssdd_block(reader, block);
    for (const SsddBlock& other : blocks)
      if (other.type == block.type)
        reader.fail("one block of each type",
                    fmt::format("two of {}", kSsddTypes[static_cast<std::size_t>(block.type)]));
    blocks.push_back(std::move(block));
  }
  return blocks;
}

}  // namespace

bool looks_like_ssdd(std::string_view text) noexcept {
  if (!first_content_line(text).starts_with("VERSION ")) return false;
  return text.substr(0, 65536).find("\nDATA_TYPE ") != std::string_view::npos;
}

SsddFile parse_ssdd(const FileBytes& file, const OpenOptions& options) {
  SsddReader reader(file);
  const std::vector<SsddBlock> blocks = read_ssdd_blocks(reader);
  std::vector<const SsddBlock*> functions;
  std::vector<BsdfBlock> parts;
  for (const SsddBlock& block : blocks)
    if (block.is_function()) {
      functions.push_back(&block);
      parts.push_back(
          {block.type == SsddType::btdf ? BsdfPart::transmission_front : BsdfPart::reflection_front, {}});
    }
  if (functions.empty()) throw Error::in_file(file.name, "DATA_TYPE brdf or btdf", "specular shares alone");
  const std::size_t chosen = choose_block(file.name, parts, options);
  const SsddBlock& block = *functions[chosen];
  check_wavelengths(file.name, block.lambda_nm);

  Findings findings;
  note_blocks(parts, chosen, options, findings);
  findings.format = "SSDD";
  findings.description = block.name;
  for (const SsddBlock& other : blocks) {
    if (&other == &block) continue;
    std::string what(kSsddTypes[static_cast<std::size_t>(other.type)]);
    std::replace(what.begin(), what.end(), '_', ' ');
    findings.left_out.push_back(other.is_function() ? lower_case(what) : what);
    if (other.type ==
        (findings.transmits() ? SsddType::specular_transmittance : SsddType::specular_reflectance))
      findings.direct = direct_shares(other);
  }
  AngleTable table = table_of(block);
  const bool is_table =
      block.params == SsddParams::specular || (block.params == SsddParams::spherical && table.isotropic());
  std::string system(kSsddParams[static_cast<std::size_t>(*block.params)]);
  std::replace(system.begin(), system.end(), '_', ' ');
  constexpr std::string_view kColours[] = {"Monochrome.", "RGB, taken as linear Rec. 709.",
                                           "XYZ became linear Rec. 709 for a D65 white.", "Spectra."};
  findings.conventions.insert(findings.conventions.begin(),
                              {fmt::format("{}, {}; values are f without the cosine, linear between nodes{}.",
                                           system, table.isotropic() ? "isotropic" : "anisotropic",
                                           is_table ? "" : ", constant beyond the ends"),
                               std::string(kColours[static_cast<std::size_t>(*block.colour)])});
  if (block.bilateral) findings.conventions.push_back("Symmetric about the plane of incidence.");
  if (block.reciprocal) findings.conventions.push_back("Reciprocal by form.");
  note_table(table, findings);
  if (block.params == SsddParams::half_difference) {
    findings.theta_i_min = findings.theta_o_min = 0;
    findings.theta_i_max = findings.theta_o_max = kHalfPi;
  }
  table = shown_spectrum(file.name, std::move(table), block.lambda_nm, options, findings);
  if (is_table) return {std::move(table), std::move(findings)};
  return {function_of_ssdd({std::move(table), *block.params, block.bilateral, block.reciprocal}),
          std::move(findings)};
}

}  // namespace burnish
