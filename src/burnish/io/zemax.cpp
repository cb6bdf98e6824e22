#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <burnish/io/text_reader.h>
#include <burnish/io/zemax.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kMaxAngles = 4096;

/// Linear Rec. 709 of XYZ relative to D65, rows R, G, B. Source: [ITU 2015].
constexpr std::array<std::array<double, 3>, 3> kRec709 = {
    // clang-format off
    {{ 3.2404542, -1.5371385, -0.4985314},
     {-0.9692660,  1.8760108,  0.0415560},
     { 0.0556434, -0.2040259,  1.0572252}}
    // clang-format on
};

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
  for (const char* keyword : {"symmetry", "spectralcontent", "scattertype"})
    if (!header.words.contains(keyword)) reader.fail(fmt::format("the keyword {}", keyword), "none");
  for (const char* keyword : {"samplerotation", "angleofincidence", "scatterazimuth"})
    if (!header.angles.contains(keyword)) reader.fail(fmt::format("the keyword {}", keyword), "none");
  if (header.words["scattertype"] != "brdf")
    reader.fail("ScatterType BRDF", in_quotes(header.words["scattertype"]));
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

/// The remark "# Sample: ..." in front of the header.
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
  const std::size_t channels = monochrome ? 1 : 3;
  const auto& rotations = header.angles["samplerotation"];
  const auto& incidences = header.angles["angleofincidence"];
  const auto& azimuths = header.angles["scatterazimuth"];
  const auto& radials = header.angles["scatterradial"];
  const std::size_t entries = rotations.size() * incidences.size() * azimuths.size() * radials.size();
  // A value takes a digit and a separator.
  if (2 * entries * channels > reader.remaining() + 1)
    reader.fail(fmt::format("{} values", entries * channels),
                fmt::format("{} bytes to the end", reader.remaining()));

  ZemaxFile result;
  Findings& findings = result.findings;
  AngleTable& table = result.table;
  table.frame = AngleTable::Frame::kSpecular;
  table.folded = header.words["symmetry"] == "planesymmetrical";
  table.axes = {make_axis(in_radians(rotations, 90), kTwoPi), make_axis(in_radians(incidences)),
                make_axis(in_radians(azimuths), table.folded ? 0 : kTwoPi), make_axis(in_radians(radials))};
  table.channel_count = static_cast<int>(channels);
  table.values.resize(entries * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    // The line that names the channel, then the data.
    if (!reader.next_content_line()) reader.fail("a channel's name", "the end of the file");
    expect_keyword(reader, "databegin");
    std::size_t entry = 0;
    for (std::size_t block = 0; block < rotations.size() * incidences.size(); ++block) {
      expect_keyword(reader, "tis");
      reader.number("TIS");
      for (std::size_t row = 0; row < azimuths.size(); ++row) {
        if (!reader.next_content_line()) reader.fail("a row of values", "the end of the file");
        for (std::size_t column = 0; column < radials.size(); ++column) {
          const double value = reader.number("a value");
          if (std::abs(value) > std::numeric_limits<float>::max())
            reader.fail("a value below 1e38", fmt::format("{}", value));
          table.values[entry++ * channels + c] = static_cast<float>(value);
        }
        reader.end_of_line();
      }
    }
    expect_keyword(reader, "dataend");
  }

  findings.theta_i_min = radians(incidences.front());
  findings.theta_i_max = radians(incidences.back());
  findings.theta_o_min = kHalfPi;
  for (std::size_t entry = 0; entry < entries; ++entry) {
    float* value = &table.values[entry * channels];
    if (std::all_of(value, value + channels, [](float v) { return v == 0; })) {
      ++findings.hole_count;
      std::fill_n(value, channels, std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    if (channels == 3) {
      const std::array<double, 3> xyz = {value[0], value[1], value[2]};
      for (std::size_t c = 0; c < 3; ++c)
        value[c] =
            static_cast<float>(kRec709[c][0] * xyz[0] + kRec709[c][1] * xyz[1] + kRec709[c][2] * xyz[2]);
    }
    for (std::size_t c = 0; c < channels; ++c)
      if (value[c] < 0) {
        ++findings.clamped_negatives;
        findings.most_negative = std::min(findings.most_negative, static_cast<double>(value[c]));
        if (options.clamp_negatives) value[c] = 0;
      }
    const std::size_t column = entry % radials.size(), row = entry / radials.size() % azimuths.size(),
                      incidence = entry / (radials.size() * azimuths.size()) % incidences.size();
    const Vec3 wo =
        around_specular(radians(incidences[incidence]), 0, radians(azimuths[row]), radians(radials[column]));
    findings.theta_o_min = std::min(findings.theta_o_min, theta_of(wo));
    findings.theta_o_max = std::max(findings.theta_o_max, theta_of(wo));
  }

  findings.format = "Zemax tabular BRDF";
  findings.description = sample_name(file);
  findings.sample_count = entries;
  findings.conventions = {
      "Azimuth and radial angles are around and from the mirror direction, azimuth 0 to the normal; linear "
      "between them.",
      "Entries of exactly zero are holes.",
      table.isotropic() ? "One sample rotation: taken as isotropic."
                        : "Sample rotation r puts the light at phi_i = r + 90 degrees.",
      monochrome ? "Monochrome." : "XYZ became linear Rec. 709 for a D65 white."};
  if (table.folded) findings.conventions.push_back("Symmetric about the plane of incidence.");
  return result;
}

}  // namespace burnish
