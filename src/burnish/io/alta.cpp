// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <burnish/io/alta.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>
#include <burnish/parameterization/half_diff.h>

namespace burnish {

namespace {

// Rounding of a file's digits may take a direction this far out of the hemisphere: 1.5708 is 3.7e-6 beyond it.
constexpr double kSlack = 1e-5;

using Coordinates = std::span<const double>;

/// Returns the pair of these angles. ALTA's difference vector is the view's, burnish's is the light's.
DirectionPair rusinkiewicz(double theta_h, double phi_h, double theta_d, double phi_d) noexcept {
  const auto [difference, other] = from_half_diff({theta_h, phi_h, theta_d, phi_d});
  return {other, difference};
}

/// Returns the direction towards (x, y) whose angle from the normal is the length of (x, y).
Vec3 projected(double x, double y) noexcept {
  return spherical_direction(std::hypot(x, y), std::atan2(y, x));
}

DirectionPair spherical(Coordinates x) noexcept {
  return {spherical_direction(x[0], x[1]), spherical_direction(x[2], x[3])};
}

DirectionPair isotropic_angles(Coordinates x) noexcept {
  return {spherical_direction(x[1], x[2]), spherical_direction(x[0], 0)};
}

DirectionPair projected_view(Coordinates x) noexcept {
  return {spherical_direction(x[0], 0), projected(x[1], x[2])};
}

/// Returns the pair whose view is the light's mirror direction reflected about the back vector.
DirectionPair schlick(Coordinates x) noexcept {
  const Vec3 light = spherical_direction(x[0], 0), mirror{-light.x, -light.y, light.z};
  const Vec3 back = projected(x[1], x[2]);
  return {light, 2 * dot(mirror, back) * back - mirror};
}

/// Returns the pair whose view lies at an angle from the light. The view's azimuth around the light counts
/// from the normal.
DirectionPair retro(Coordinates x) noexcept {
  const Vec3 light = spherical_direction(x[0], 0), to_normal{-light.z, 0, light.x}, across{0, 1, 0};
  const double angle = std::hypot(x[1], x[2]), azimuth = std::atan2(x[2], x[1]);
  const Vec3 tangent = std::cos(azimuth) * to_normal + std::sin(azimuth) * across;
  return {light, std::cos(angle) * light + std::sin(angle) * tangent};
}

/// Returns the pair of |H| in the tangent plane, |B| and the azimuth between them. H = (L + V) / 2, B = (L - V) / 2.
DirectionPair stark(Coordinates x) noexcept {
  const Vec3 half{x[0], 0, std::sqrt(std::max(1 - x[0] * x[0] - x[1] * x[1], 0.0))};
  // B is orthogonal to H.
  const double theta = std::atan2(-half.z, x[0] * std::cos(x[2]));
  const Vec3 back =
      x[1] * Vec3{std::sin(theta) * std::cos(x[2]), std::sin(theta) * std::sin(x[2]), std::cos(theta)};
  return {half + back, half - back};
}

/// Returns the pair of |H| and |B|, both in the tangent plane, and the azimuth between them.
DirectionPair neumann(Coordinates x) noexcept {
  const auto raised = [](double a, double b) {
    return Vec3{a, b, std::sqrt(std::max(1 - a * a - b * b, 0.0))};
  };
  const double bx = x[1] * std::cos(x[2]), by = x[1] * std::sin(x[2]);
  return {raised(x[0] - bx, -by), raised(x[0] + bx, by)};
}

DirectionPair stereographic(Coordinates x) noexcept {
  const auto lifted = [](double a, double b) {
    const double square = a * a + b * b;
    return (1 / (1 + square)) * Vec3{2 * a, 2 * b, 1 - square};
  };
  return {lifted(x[2], x[3]), lifted(x[0], x[1])};
}

DirectionPair cartesian(Coordinates x) noexcept {
  return {{x[3], x[4], x[5]}, {x[0], x[1], x[2]}};
}

/// A kind of coordinates in a row.
struct Parameterization {
  std::string_view name;
  std::size_t coordinates;
  bool isotropic;
  DirectionPair (*directions)(Coordinates) noexcept;
  std::string_view said;
};

constexpr std::array kParameterizations = {
    Parameterization{"RUSIN_TH_TD_PD", 3, true,
                     [](Coordinates x) noexcept { return rusinkiewicz(x[0], 0, x[1], x[2]); },
                     "theta_h, theta_d, phi_d of the view"},
    Parameterization{"RUSIN_TH_PH_TD", 3, false,
                     [](Coordinates x) noexcept { return rusinkiewicz(x[0], x[1], x[2], 0); },
                     "theta_h, phi_h, theta_d; phi_d is 0, as in ALTA"},
    Parameterization{"RUSIN_TH_PH_TD_PD", 4, false,
                     [](Coordinates x) noexcept { return rusinkiewicz(x[0], x[1], x[2], x[3]); },
                     "theta_h, phi_h, theta_d, phi_d of the view"},
    Parameterization{"SPHERICAL_TL_PL_TV_PV", 4, false, spherical, "theta_i, phi_i, theta_o, phi_o"},
    Parameterization{"ISOTROPIC_TV_TL_DPHI", 3, true, isotropic_angles, "theta_o, theta_i, phi_i - phi_o"},
    Parameterization{"ISOTROPIC_TL_TV_PROJ_DPHI", 3, true, projected_view,
                     "theta_i, theta_o cos(phi_o - phi_i), theta_o sin(phi_o - phi_i)"},
    Parameterization{"SCHLICK_TL_TK_PROJ_DPHI", 3, true, schlick,
                     "theta_i, theta_k cos(phi), theta_k sin(phi)"},
    Parameterization{"RETRO_TL_TVL_PROJ_DPHI", 3, true, retro,
                     "theta_i, the angle between the directions times cosine and sine of its azimuth"},
    Parameterization{"STARK_3D", 3, true, stark, "|H| in the tangent plane, |B|, the azimuth between them"},
    Parameterization{"NEUMANN_3D", 3, true, neumann,
                     "|H| and |B| in the tangent plane, the azimuth between them"},
    Parameterization{"STEREOGRAPHIC", 4, false, stereographic, "stereographic projections of view and light"},
    Parameterization{"CARTESIAN", 6, false, cartesian, "components of view and light"}};

/// The header's keys.
struct Header {
  std::size_t inputs = 0, outputs = 0, extra = 0;
  const Parameterization* parameterization = nullptr;
  bool cosine = false;
  std::string sample;
};

const Parameterization& find_parameterization(const TextReader& reader, std::string_view name) {
  const auto found = std::find_if(kParameterizations.begin(), kParameterizations.end(),
                                  [&](const Parameterization& p) { return p.name == name; });
  if (found == kParameterizations.end())
    reader.fail("a #PARAM_IN of three or four angles that determine both directions", in_quotes(name));
  return *found;
}

void read_key(TextReader& reader, Header& header) {
  const std::string key(reader.word());
  if (key == "#DIM") {
    header.inputs = reader.count("the number of coordinates", 1, 6);
    header.outputs = reader.count("the number of values", 1, kMaxFileChannels);
  } else if (key == "#PARAM_IN") {
    header.parameterization = &find_parameterization(reader, reader.word());
  } else if (key == "#PARAM_OUT") {
    const std::string_view out = reader.word();
    header.cosine = out == "INV_STERADIAN_COSINE_FACTOR";
    if (out == "ENERGY" || out == "XYZ_COLOR")
      reader.fail("#PARAM_OUT INV_STERADIAN, INV_STERADIAN_COSINE_FACTOR or RGB_COLOR", in_quotes(out));
  } else if (key == "#VS") {
    // Each value has 0, 1 or 2 more numbers.
    for (std::string_view word = reader.word(); !word.empty(); word = reader.word()) {
      if (word != "0" && word != "1" && word != "2") reader.fail("#VS of 0, 1 or 2", in_quotes(word));
      header.extra += static_cast<std::size_t>(word[0] - '0');
    }
  } else if (key == "#SAMPLE") {
    const std::string_view rest = trimmed(reader.line().substr(key.size()));
    const std::size_t quote = rest.starts_with('"') && rest.ends_with('"') && rest.size() > 1 ? 1 : 0;
    header.sample = printable(rest.substr(quote, rest.size() - 2 * quote), 160);
  } else if (key == "#FORMAT" && reader.word() == "binary") {
    reader.fail("ALTA text", "#FORMAT binary");
  }
}

/// Reads the header and leaves the reader at the first row.
Header read_header(TextReader& reader) {
  Header header;
  bool row = false;
  while (!row && reader.next_line()) {
    const std::string_view line = trimmed(reader.line());
    row = !line.empty() && !line.starts_with('#');
    if (line.starts_with('#')) read_key(reader, header);
  }
  if (!row) reader.fail("a row of numbers", "the end of the file");
  if (!header.parameterization) reader.fail("#PARAM_IN in front of the data", "none");
  if (header.inputs != header.parameterization->coordinates)
    reader.fail(
        fmt::format("#DIM {} for {}", header.parameterization->coordinates, header.parameterization->name),
        fmt::format("#DIM {}", header.inputs));
  if (header.outputs != 1 && header.outputs != 3)
    reader.fail("one value or three in #DIM", fmt::format("{}", header.outputs));
  return header;
}

/// Returns a direction of the upper hemisphere. A direction that rounding took below the horizon is put onto
/// it. Throws Error for any other.
Vec3 checked(const TextReader& reader, Vec3 w) {
  if (!(std::abs(length(w) - 1) < 1e-3 && w.z >= -kSlack))
    reader.fail("coordinates of two directions of the upper hemisphere",
                fmt::format("({:.4g}, {:.4g}, {:.4g})", w.x, w.y, w.z));
  return normalize({w.x, w.y, std::max(w.z, 0.0)});
}

}  // namespace

bool looks_like_alta(std::string_view text) noexcept {
  text = text.substr(0, 65536);
  while (text.starts_with('#')) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.starts_with("#DIM") || line.starts_with("#PARAM_IN")) return true;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return false;
}

SampleFile parse_alta(const FileBytes& file, const OpenOptions& options) {
  TextReader reader(file);
  const Header header = read_header(reader);
  SampleFile result;
  Samples& samples = result.samples;
  Findings& findings = result.findings;
  findings.format = "ALTA scattered samples";
  findings.description = header.sample;
  findings.conventions = {
      fmt::format("{}: {}; the light is wi, the view wo.", header.parameterization->name,
                  header.parameterization->said),
      header.parameterization->isotropic ? "Isotropic by its coordinates." : "Taken as anisotropic."};
  if (header.cosine) findings.conventions.push_back("Values contain cos(theta_o): it is divided out.");
  samples.channels = static_cast<int>(header.outputs);
  samples.isotropic = header.parameterization->isotropic;

  std::array<double, 6> row{};
  const auto coordinates = std::span(row).first(header.inputs);
  do {
    for (double& x : coordinates) x = reader.number("a coordinate");
    const DirectionPair pair = header.parameterization->directions(coordinates);
    const Vec3 wi = checked(reader, pair.wi), wo = checked(reader, pair.wo);
    if (header.cosine && wo.z <= kSlack) {
      // 0 / 0 gives no value of f_r.
      ++findings.hole_count;
      continue;
    }
    samples.pairs.push_back({wi, wo});
    for (std::size_t c = 0; c < header.outputs; ++c)
      samples.values.push_back(reader.number("a value") / (header.cosine ? wo.z : 1));
    for (std::size_t k = 0; k < header.extra; ++k) reader.number("an interval");
    reader.end_of_line();
  } while (reader.next_content_line());
  finish_samples(file.name, options, result);
  return result;
}

}  // namespace burnish
