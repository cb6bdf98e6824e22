// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <burnish/io/part_choice.h>
#include <burnish/io/stated_totals.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/zemax.h>
#include <burnish/math/angles.h>
#include <burnish/math/rec709_d65.h>
#include <burnish/math/written_degrees.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxAngles = 4096;

using Row = std::array<double, 3>;

double product(const Row& row, const double* v) noexcept {
  return row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
}

/// Returns the inverse by cofactors, so that written values are read back to rounding.
std::array<Row, 3> inverse(const std::array<Row, 3>& m) noexcept {
  std::array<Row, 3> result;
  const auto minor_of = [&](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * minor_of(0, 0) + m[0][1] * minor_of(0, 1) + m[0][2] * minor_of(0, 2);
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) result[r][c] = minor_of(c, r) / determinant;
  return result;
}

struct Header {
  std::map<std::string, std::string> words;           // keyword in lower case -> value in lower case
  std::map<std::string, std::vector<double>> angles;  // keyword in lower case -> degrees
};

std::vector<double> read_angles(TextReader& reader, std::string_view keyword) {
  const std::size_t count = reader.count(fmt::format("the number of {} angles", keyword), 1, kMaxAngles);
  reader.end_of_line();
  std::vector<double> angles;
  while (angles.size() < count) {
    if (!reader.next_content_line()) reader.fail(fmt::format("{} angles", count), "the end of the file");
    for (;;) {
      TextReader ahead = reader;
      if (angles.size() == count || ahead.word().empty()) break;
      angles.push_back(reader.number(keyword));
    }
  }
  reader.end_of_line();
  if (std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>{}) != angles.end())
    reader.fail(fmt::format("increasing {} angles", keyword), in_quotes(reader.line()));
  return angles;
}

/// Reads keywords up to the block of the first channel.
Header read_header(TextReader& reader) {
  // Keywords have a word or a list of angles. They come in any order, but ScatterRadial is the last.
  Header header;
  while (header.angles.find("scatterradial") == header.angles.end()) {
    if (!reader.next_content_line()) reader.fail("the keyword ScatterRadial", "the end of the file");
    const std::string keyword = lower_case(reader.word());
    if (keyword == "source" || keyword == "symmetry" || keyword == "spectralcontent" ||
        keyword == "scattertype") {
      header.words[keyword] = lower_case(reader.word());
      reader.end_of_line();
    } else if (keyword == "samplerotation" || keyword == "angleofincidence" || keyword == "scatterazimuth" ||
               keyword == "scatterradial") {
      header.angles[keyword] = read_angles(reader, keyword);
    } else {
      reader.fail("a keyword of the header", in_quotes(reader.line()));
    }
  }

  // All keywords have to be there, with values that the format knows.
  for (const char* keyword : {"symmetry", "spectralcontent", "scattertype"})
    if (!header.words.contains(keyword)) reader.fail(fmt::format("the keyword {}", keyword), "none");
  for (const char* keyword : {"samplerotation", "angleofincidence", "scatterazimuth"})
    if (!header.angles.contains(keyword)) reader.fail(fmt::format("the keyword {}", keyword), "none");

  if (header.words["scattertype"] != "brdf" && header.words["scattertype"] != "btdf")
    reader.fail("ScatterType BRDF or BTDF", in_quotes(header.words["scattertype"]));
  const std::string& symmetry = header.words["symmetry"];
  if (symmetry != "planesymmetrical" && symmetry != "asymmetrical" && symmetry != "asymmetrical4d")
    reader.fail("Symmetry PlaneSymmetrical, Asymmetrical or Asymmetrical4D", in_quotes(symmetry));

  for (const char* keyword : {"angleofincidence", "scatterradial"}) {
    const auto& angles = header.angles[keyword];
    const double most = keyword[0] == 'a' ? 90 : 180;
    if (angles.front() < 0 || angles.back() > most)
      reader.fail(fmt::format("{} in [0, {}] degrees", keyword, most),
                  fmt::format("{} ... {}", angles.front(), angles.back()));
  }
  for (const char* keyword : {"samplerotation", "scatterazimuth"})
    if (const auto& angles = header.angles[keyword];
        std::abs(angles.front()) > 360 || angles.back() - angles.front() > 360)
      reader.fail(fmt::format("{} within one turn", keyword),
                  fmt::format("{} ... {}", angles.front(), angles.back()));
  return header;
}

void expect_keyword(TextReader& reader, std::string_view keyword) {
  if (!reader.next_content_line()) reader.fail(std::string(keyword), "the end of the file");
  if (lower_case(reader.word()) != keyword) reader.fail(std::string(keyword), in_quotes(reader.line()));
}

std::vector<double> in_radians(const std::vector<double>& angles_deg, double offset_deg = 0) {
  std::vector<double> angles;
  for (const double angle : angles_deg) angles.push_back(radians(angle + offset_deg));
  return angles;
}

/// Written in place of a value of 0, since 0 is a hole.
constexpr double kWrittenZero = 1e-30;

/// Appends a line of the keyword and the count, then one of the angles in degrees, less `offset_deg`.
void append_angles(std::string& text, std::string_view keyword, const AngleAxis& axis,
                   double offset_deg = 0) {
  std::vector<double> angles;
  for (const double node : axis.nodes) angles.push_back(written_degrees(node, offset_deg));
  text += fmt::format("{}\t{}\n{}\n", keyword, angles.size(), fmt::join(angles, "\t"));
}

/// Returns the middles between neighbours, and the two ends.
std::vector<double> cell_borders(const std::vector<double>& nodes) {
  std::vector<double> borders = {nodes.front()};
  for (std::size_t i = 1; i < nodes.size(); ++i) borders.push_back(0.5 * (nodes[i - 1] + nodes[i]));
  borders.push_back(nodes.back());
  return borders;
}

/// Returns the part of the circle that each azimuth stands for, in radians; in a folded table it counts both sides.
std::vector<double> azimuth_widths(const AngleAxis& axis, bool folded) {
  if (axis.nodes.size() == 1) return {kTwoPi};
  const std::vector<double> borders = cell_borders(axis.nodes);
  std::vector<double> widths;
  for (std::size_t i = 0; i < axis.nodes.size(); ++i)
    widths.push_back((folded ? 2 : 1) * (borders[i + 1] - borders[i]));
  if (axis.closed) {
    const double gap = axis.period - (axis.nodes.back() - axis.nodes.front());
    widths.front() += 0.5 * gap;
    widths.back() += 0.5 * gap;
  }
  return widths;
}

/// Returns the solid angle over 2 pi of the ring around each radial angle.
std::vector<double> ring_heights(const AngleAxis& axis) {
  const std::vector<double> borders = cell_borders(axis.nodes);
  std::vector<double> heights;
  for (std::size_t i = 0; i < axis.nodes.size(); ++i)
    heights.push_back(std::cos(borders[i]) - std::cos(borders[i + 1]));
  return heights;
}

/// Counts of a file's blocks, rows and columns.
struct TableSizes {
  std::size_t rotations, incidences, azimuths, radials, channels;

  std::size_t blocks() const noexcept { return rotations * incidences; }
  std::size_t entries() const noexcept { return blocks() * azimuths * radials; }
};

/// Reads the data of one channel: for every block the integral TIS, then rows of azimuths. Writes one value for each
/// entry to `entries`, `stride` apart, and returns the TIS of the blocks.
std::vector<double> read_channel(TextReader& reader, const TableSizes& sizes, double* entries,
                                 std::size_t stride) {
  std::vector<double> totals;
  // A line names the channel, then come the data.
  if (!reader.next_content_line()) reader.fail("a channel's name", "the end of the file");
  expect_keyword(reader, "databegin");
  std::size_t entry = 0;
  for (std::size_t block = 0; block < sizes.blocks(); ++block) {
    expect_keyword(reader, "tis");
    totals.push_back(reader.number("TIS"));
    for (std::size_t row = 0; row < sizes.azimuths; ++row) {
      if (!reader.next_content_line()) reader.fail("a row of values", "the end of the file");
      for (std::size_t column = 0; column < sizes.radials; ++column) {
        const double value = reader.number("a value");
        if (std::abs(value) > std::numeric_limits<float>::max())
          reader.fail("a value below 1e38", fmt::format("{}", value));
        entries[entry++ * stride] = value;
      }
      reader.end_of_line();
    }
  }
  expect_keyword(reader, "dataend");
  return totals;
}

/// Fills the table with the values read, grey or XYZ, and notes holes, negative values and angles.
void fill_values(const std::vector<double>& read, const Header& header, const TableSizes& sizes,
                 ZemaxFile& result) {
  const std::size_t channels = sizes.channels;
  const auto& incidences = header.angles.at("angleofincidence");
  const auto& azimuths = header.angles.at("scatterazimuth");
  const auto& radials = header.angles.at("scatterradial");
  Findings& findings = result.findings;
  result.table.values.resize(read.size());
  for (std::size_t entry = 0; entry < sizes.entries(); ++entry) {
    float* value = &result.table.values[entry * channels];
    const double* from = &read[entry * channels];
    if (std::all_of(from, from + channels, [](double v) { return v == 0; })) {
      ++findings.hole_count;
      std::fill_n(value, channels, std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    if (channels == 1)
      value[0] = static_cast<float>(from[0]);
    else
      for (std::size_t c = 0; c < 3; ++c) value[c] = static_cast<float>(product(kRec709OfD65[c], from));

    for (std::size_t c = 0; c < channels; ++c)
      if (value[c] < 0) {
        ++findings.negative_count;
        findings.most_negative = std::min(findings.most_negative, static_cast<double>(value[c]));
      }

    // theta_o is the same for every rotation of the sample.
    const std::size_t column = entry % radials.size(), row = entry / radials.size() % azimuths.size(),
                      incidence = entry / (radials.size() * azimuths.size()) % incidences.size();
    const Vec3 wo =
        around_specular(radians(incidences[incidence]), 0, radians(azimuths[row]), radians(radials[column]));
    findings.theta_o_min = std::min(findings.theta_o_min, theta_of(wo));
    findings.theta_o_max = std::max(findings.theta_o_max, std::min(theta_of(wo), kHalfPi));
  }
}

/// Returns the reflected share of the light at every rotation and incidence: the sum of values times the cosine
/// and the solid angle that each entry stands for.
std::vector<Row> block_integrals(const AngleTable& table) {
  const auto& axes = table.axes;
  const auto channels = table.channel_count;
  const std::size_t columns = axes[3].nodes.size(), block = axes[2].nodes.size() * columns;
  const std::vector<double> around = azimuth_widths(axes[2], table.folded), along = ring_heights(axes[3]);
  std::vector<Row> totals(axes[0].nodes.size() * axes[1].nodes.size(), Row{});
  for (std::size_t entry = 0; entry < totals.size() * block; ++entry) {
    const float* value = &table.values[entry * channels];
    if (std::isnan(value[0])) continue;
    const double cosine = node_directions(table, node_of_entry(table, entry)).wo.z;
    const double weight = std::max(cosine, 0.0) * around[entry % block / columns] * along[entry % columns];
    for (std::size_t k = 0; k < channels; ++k)
      totals[entry / block][k] += weight * static_cast<double>(value[k]);
  }
  return totals;
}

/// Returns the comments of a file without their marks. Control characters other than tabs become '?'.
std::vector<std::string> comments_of(const FileBytes& file) {
  constexpr std::size_t kMost = 200, kLongest = 400;
  std::vector<std::string> comments;
  TextReader reader(file);
  while (comments.size() < kMost && reader.next_line())
    if (reader.line().starts_with('#')) {
      std::string& comment = comments.emplace_back(reader.line().substr(1, kLongest));
      std::replace_if(
          comment.begin(), comment.end(), [](unsigned char c) { return c < ' ' && c != '\t'; }, '?');
    }
  return comments;
}

/// Returns the remark "# Sample: ..." in front of the header.
std::string sample_name(const FileBytes& file) {
  TextReader reader(file);
  while (reader.next_line() && reader.line().starts_with('#')) {
    const std::string_view remark = trimmed(reader.line().substr(1));
    if (remark.starts_with("Sample:")) return printable(trimmed(remark.substr(7)), 200);
  }
  return {};
}

}  // namespace

bool looks_like_zemax(std::string_view text) noexcept {
  const std::string_view line = trimmed(first_content_line(text));
  return line.starts_with("Source ") || line.starts_with("Source\t");
}

ZemaxFile parse_zemax(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  Header header = read_header(reader);
  const bool monochrome = header.words["spectralcontent"] == "monochrome";
  if (!monochrome && header.words["spectralcontent"] != "xyz")
    reader.fail("SpectralContent Monochrome or XYZ", in_quotes(header.words["spectralcontent"]));
  const auto& rotations = header.angles["samplerotation"];
  const auto& incidences = header.angles["angleofincidence"];
  const auto& azimuths = header.angles["scatterazimuth"];
  const auto& radials = header.angles["scatterradial"];
  const TableSizes sizes{.rotations = rotations.size(),
                         .incidences = incidences.size(),
                         .azimuths = azimuths.size(),
                         .radials = radials.size(),
                         .channels = monochrome ? 1u : 3u};
  // A value takes at least a digit and a separator.
  const std::size_t values = sizes.entries() * sizes.channels;
  if (2 * values > reader.remaining() + 1)
    reader.fail(fmt::format("{} values", values), fmt::format("{} bytes to the end", reader.remaining()));

  ZemaxFile result;
  AngleTable& table = result.table;
  table.frame = AngleTable::Frame::specular;
  table.folded = header.words["symmetry"] == "planesymmetrical";
  table.axes = {make_axis(in_radians(rotations, 90), kTwoPi), make_axis(in_radians(incidences)),
                make_axis(in_radians(azimuths), table.folded ? 0 : kTwoPi), make_axis(in_radians(radials))};
  table.channel_count = sizes.channels;

  // The file has one channel after another, the table all channels of an entry together.
  std::vector<double> read(values);
  std::vector<double> totals;
  for (std::size_t c = 0; c < sizes.channels; ++c) {
    std::vector<double> of_channel = read_channel(reader, sizes, &read[c], sizes.channels);
    if (c == sizes.channels / 2) totals = std::move(of_channel);  // Y of XYZ
  }

  Findings& findings = result.findings;
  findings.theta_i_min = radians(incidences.front());
  findings.theta_i_max = radians(incidences.back());
  findings.theta_o_min = kHalfPi;
  fill_values(read, header, sizes, result);

  const bool transmits = header.words["scattertype"] == "btdf";
  const BsdfBlock only{transmits ? BsdfPart::transmission_front : BsdfPart::reflection_front, {}};
  findings.format = transmits ? "Zemax tabular BTDF" : "Zemax tabular BRDF";
  findings.description = sample_name(file);
  findings.sample_count = sizes.entries();
  findings.conventions = {
      transmits ? "Azimuth and radial angles are around and from the direction straight on, azimuth 0 to the "
                  "normal; linear between them."
                : "Azimuth and radial angles are around and from the mirror direction, azimuth 0 to the "
                  "normal; linear between them.",
      "Entries of exactly zero are holes.",
      table.isotropic() ? "One sample rotation: taken as isotropic."
                        : "Sample rotation r puts the light at phi_i = r + 90 degrees.",
      monochrome ? "Monochrome." : "XYZ became linear Rec. 709 for a D65 white."};
  if (table.folded) findings.conventions.push_back("Symmetric about the plane of incidence.");
  findings.comments = comments_of(file);
  note_blocks({&only, 1}, choose_block(file.name, {&only, 1}, options), options, findings);
  if (options.scale_to_tis)
    scale_to_totals(table, totals, findings);
  else
    check_totals(table, totals, findings);
  return result;
}

AngleTable zemax_layout(bool isotropic) {
  const auto steps = [](int count, double step_deg, double first_deg = 0) {
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) angles.push_back(first_deg + step_deg * i);
    return angles;
  };
  std::vector<double> radials = {0, 0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12.5};
  for (const double r : steps(15, 5, 15)) radials.push_back(r);
  for (const double r : steps(9, 10, 95)) radials.push_back(r);
  std::vector<double> incidences = steps(9, 10);
  incidences.push_back(85);
  AngleTable table;
  table.frame = AngleTable::Frame::specular;
  table.folded = isotropic;
  if (isotropic)
    table.axes = {make_axis(in_radians({0}, 90), kTwoPi), make_axis(in_radians(steps(18, 5))),
                  make_axis(in_radians(steps(37, 5))), make_axis(in_radians(radials))};
  else
    table.axes = {make_axis(in_radians(steps(36, 10), 90), kTwoPi), make_axis(in_radians(incidences)),
                  make_axis(in_radians(steps(36, 10)), kTwoPi), make_axis(in_radians(radials))};
  return table;
}

bool fits_zemax(const AngleTable& table) noexcept {
  return table.frame == AngleTable::Frame::specular && table.centre_theta.empty() &&
         (table.channel_count == 1 || table.channel_count == 3);
}

std::string format_zemax(const AngleTable& table, std::string_view sample,
                         std::span<const std::string> comments, BsdfPart part) {
  if (!fits_zemax(table))
    throw Error("Zemax table: expected values around the mirror direction, grey or RGB");
  const auto& axes = table.axes;
  const auto channels = table.channel_count;
  const bool monochrome = channels == 1;
  std::string text;
  for (const std::string& comment : comments) text += fmt::format("#{}\n", comment);
  if (comments.empty()) text = fmt::format("# Sample: {}\n", printable(sample, 200));
  text += fmt::format("Source\tMeasured\nSymmetry\t{}\nSpectralContent\t{}\nScatterType\t{}\n",
                      table.folded        ? "PlaneSymmetrical"
                      : table.isotropic() ? "Asymmetrical"
                                          : "Asymmetrical4D",
                      monochrome ? "Monochrome" : "XYZ", is_transmission(part) ? "BTDF" : "BRDF");
  append_angles(text, "SampleRotation", axes[0], 90);
  append_angles(text, "AngleOfIncidence", axes[1]);
  append_angles(text, "ScatterAzimuth", axes[2]);
  append_angles(text, "ScatterRadial", axes[3]);

  // Channels follow one another. Each begins its blocks with TIS, which readers expect although the entries
  // determine it.
  const auto to_xyz = inverse(kRec709OfD65);
  const std::vector<Row> totals = block_integrals(table);
  const std::size_t columns = axes[3].nodes.size(), block = axes[2].nodes.size() * columns;
  constexpr std::array kNames = {"TristimulusX", "TristimulusY", "TristimulusZ"};
  for (std::size_t c = 0; c < channels; ++c) {
    // This channel is computed from the values of all channels.
    const auto channel = [&](const double* values) {
      return monochrome ? values[0] : product(to_xyz[c], values);
    };
    text += fmt::format("\n{}\nDataBegin\n", monochrome ? "Monochrome" : kNames[c]);
    for (std::size_t b = 0; b < totals.size(); ++b) {
      text += fmt::format("TIS\t{:.6g}\n", channel(totals[b].data()));
      for (std::size_t entry = b * block; entry < (b + 1) * block; ++entry) {
        const float* value = &table.values[entry * channels];
        const Row values = {value[0], value[channels == 3], value[channels - 1]};
        const double written = channel(values.data());
        text += fmt::format("{}{}",
                            std::isnan(value[0]) ? 0.0
                            : written == 0       ? kWrittenZero
                                                 : written,
                            (entry + 1) % columns == 0 ? '\n' : '\t');
      }
    }
    text += "DataEnd\n";
  }
  return text;
}

}  // namespace burnish
