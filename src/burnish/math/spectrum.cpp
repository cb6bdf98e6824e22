// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/spectrum.h>
#include <burnish/math/vec3.h>

namespace burnish {
namespace {

struct CieRow {
  double x, y, z;  // colour matching functions
  double d65;      // relative power of illuminant D65
};

constexpr double kFirst_nm = 380, kStep_nm = 5;

// CIE 1931 standard observer and CIE D65, 380 nm to 780 nm every 5 nm. [CIE 2018]
// clang-format off
constexpr CieRow kCie[] = {
    {0.001368, 3.9e-05, 0.006450001, 49.9755}, {0.002236, 6.4e-05, 0.01054999, 52.3118},
    {0.004243, 0.00012, 0.02005001, 54.6482}, {0.00765, 0.000217, 0.03621, 68.7015},
    {0.01431, 0.000396, 0.06785001, 82.7549}, {0.02319, 0.00064, 0.1102, 87.1204},
    {0.04351, 0.00121, 0.2074, 91.486}, {0.07763, 0.00218, 0.3713, 92.4589},
    {0.13438, 0.004, 0.6456, 93.4318}, {0.21477, 0.0073, 1.03905, 90.057},
    {0.2839, 0.0116, 1.3856, 86.6823}, {0.3285, 0.01684, 1.62296, 95.7736},
    {0.34828, 0.023, 1.74706, 104.865}, {0.34806, 0.0298, 1.7826, 110.936},
    {0.3362, 0.038, 1.77211, 117.008}, {0.3187, 0.048, 1.7441, 117.41},
    {0.2908, 0.06, 1.6692, 117.812}, {0.2511, 0.0739, 1.5281, 116.336},
    {0.19536, 0.09098, 1.28764, 114.861}, {0.1421, 0.1126, 1.0419, 115.392},
    {0.09564, 0.13902, 0.8129501, 115.923}, {0.05795001, 0.1693, 0.6162, 112.367},
    {0.03201, 0.20802, 0.46518, 108.811}, {0.0147, 0.2586, 0.3533, 109.082},
    {0.0049, 0.323, 0.272, 109.354}, {0.0024, 0.4073, 0.2123, 108.578},
    {0.0093, 0.503, 0.1582, 107.802}, {0.0291, 0.6082, 0.1117, 106.296},
    {0.06327, 0.71, 0.07824999, 104.79}, {0.1096, 0.7932, 0.05725001, 106.239},
    {0.1655, 0.862, 0.04216, 107.689}, {0.2257499, 0.9148501, 0.02984, 106.047},
    {0.2904, 0.954, 0.0203, 104.405}, {0.3597, 0.9803, 0.0134, 104.225},
    {0.4334499, 0.9949501, 0.008749999, 104.046}, {0.5120501, 1, 0.005749999, 102.023},
    {0.5945, 0.995, 0.0039, 100}, {0.6784, 0.9786, 0.002749999, 98.1671},
    {0.7621, 0.952, 0.0021, 96.3342}, {0.8425, 0.9154, 0.0018, 96.0611},
    {0.9163, 0.87, 0.001650001, 95.788}, {0.9786, 0.8163, 0.0014, 92.2368},
    {1.0263, 0.757, 0.0011, 88.6856}, {1.0567, 0.6949, 0.001, 89.3459},
    {1.0622, 0.631, 0.0008, 90.0062}, {1.0456, 0.5668, 0.0006, 89.8026},
    {1.0026, 0.503, 0.00034, 89.5991}, {0.9384, 0.4412, 0.00024, 88.6489},
    {0.8544499, 0.381, 0.00019, 87.6987}, {0.7514, 0.321, 0.0001, 85.4936},
    {0.6424, 0.265, 4.999999e-05, 83.2886}, {0.5419, 0.217, 3e-05, 83.4939},
    {0.4479, 0.175, 2e-05, 83.6992}, {0.3608, 0.1382, 1e-05, 81.863},
    {0.2835, 0.107, 0, 80.0268}, {0.2187, 0.0816, 0, 80.1207},
    {0.1649, 0.061, 0, 80.2146}, {0.1212, 0.04458, 0, 81.2462},
    {0.0874, 0.032, 0, 82.2778}, {0.0636, 0.0232, 0, 80.281},
    {0.04677, 0.017, 0, 78.2842}, {0.0329, 0.01192, 0, 74.0027},
    {0.0227, 0.00821, 0, 69.7213}, {0.01584, 0.005723, 0, 70.6652},
    {0.01135916, 0.004102, 0, 71.6091}, {0.008110916, 0.002929, 0, 72.979},
    {0.005790346, 0.002091, 0, 74.349}, {0.004109457, 0.001484, 0, 67.9765},
    {0.002899327, 0.001047, 0, 61.604}, {0.00204919, 0.00074, 0, 65.7448},
    {0.001439971, 0.00052, 0, 69.8856}, {0.0009999493, 0.0003611, 0, 72.4863},
    {0.0006900786, 0.0002492, 0, 75.087}, {0.0004760213, 0.0001719, 0, 69.3398},
    {0.0003323011, 0.00012, 0, 63.5927}, {0.0002348261, 8.48e-05, 0, 55.0054},
    {0.0001661505, 6e-05, 0, 46.4182}, {0.000117413, 4.24e-05, 0, 56.6118},
    {8.307527e-05, 3e-05, 0, 66.8054}, {5.870652e-05, 2.12e-05, 0, 65.0941},
    {4.150994e-05, 1.499e-05, 0, 63.3828},
};
// clang-format on
constexpr int kRows = static_cast<int>(std::size(kCie));
constexpr double kLast_nm = kFirst_nm + kStep_nm * (kRows - 1);
static_assert(kLast_nm == 780);

CieRow cie_at(double lambda_nm) noexcept {
  if (!(lambda_nm >= kFirst_nm && lambda_nm <= kLast_nm)) return {};
  const double at = (lambda_nm - kFirst_nm) / kStep_nm;
  const int i = std::min(static_cast<int>(at), kRows - 2);
  const double t = at - i;
  const auto mix = [t](double a, double b) { return (1 - t) * a + t * b; };
  const CieRow &a = kCie[i], &b = kCie[i + 1];
  return {mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.d65, b.d65)};
}

/// Rows of a 3x3 matrix.
struct Matrix3 {
  Vec3 r0, r1, r2;

  Vec3 operator*(Vec3 v) const noexcept { return {dot(r0, v), dot(r1, v), dot(r2, v)}; }
};

/// Inverse of the matrix with the columns a, b, c.
Matrix3 inverse_of_columns(Vec3 a, Vec3 b, Vec3 c) noexcept {
  const double s = 1 / dot(a, cross(b, c));
  return {s * cross(b, c), s * cross(c, a), s * cross(a, b)};
}

Vec3 xyz_of_chromaticity(double x, double y) noexcept {
  return {x / y, 1, (1 - x - y) / y};
}

const Vec3 kWhite = xyz_of_chromaticity(0.3127, 0.3290);  // [ITU 2015]

/// XYZ to linear Rec. 709, from the primaries and the white point (which becomes 1, 1, 1). [ITU 2015]
Vec3 rec709_of_xyz(Vec3 xyz) noexcept {
  static const Matrix3 inverse = inverse_of_columns(
      xyz_of_chromaticity(0.64, 0.33), xyz_of_chromaticity(0.30, 0.60), xyz_of_chromaticity(0.15, 0.06));
  const Vec3 primary = inverse * xyz, white = inverse * kWhite;
  return {primary.x / white.x, primary.y / white.y, primary.z / white.z};
}

/// Bradford adaptation of `xyz` seen under `from` to the white of Rec. 709. [Lam 1985]
Vec3 adapt(Vec3 xyz, Vec3 from) noexcept {
  constexpr Vec3 r0{0.8951, 0.2664, -0.1614}, r1{-0.7502, 1.7135, 0.0367}, r2{0.0389, -0.0685, 1.0296};
  constexpr Matrix3 cone{r0, r1, r2};
  static const Matrix3 inverse =
      inverse_of_columns({r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z});
  const Vec3 c = cone * xyz, source = cone * from, target = cone * kWhite;
  return inverse * Vec3{c.x * target.x / source.x, c.y * target.y / source.y, c.z * target.z / source.z};
}

/// Mean and first two components of daylight, every 10 nm from 380 nm on. [CIE 2018]
constexpr std::array<std::array<double, 3>, 41> kDaylight{
    {{63.4, 38.5, 3.0},   {65.8, 35.0, 1.2},   {94.8, 43.4, -1.1},  {104.8, 46.3, -0.5}, {105.9, 43.9, -0.7},
     {96.8, 37.1, -1.2},  {113.9, 36.7, -2.6}, {125.6, 35.9, -2.9}, {125.5, 32.6, -2.8}, {121.3, 27.9, -2.6},
     {121.3, 24.3, -2.6}, {113.5, 20.1, -1.8}, {113.1, 16.2, -1.5}, {110.8, 13.2, -1.3}, {106.5, 8.6, -1.2},
     {108.8, 6.1, -1.0},  {105.3, 4.2, -0.5},  {104.4, 1.9, -0.3},  {100.0, 0.0, 0.0},   {96.0, -1.6, 0.2},
     {95.1, -3.5, 0.5},   {89.1, -3.5, 2.1},   {90.5, -5.8, 3.2},   {90.3, -7.2, 4.1},   {88.4, -8.6, 4.7},
     {84.0, -9.5, 5.1},   {85.1, -10.9, 6.7},  {81.9, -10.7, 7.3},  {82.6, -12.0, 8.6},  {84.9, -14.0, 9.8},
     {81.3, -13.6, 10.2}, {71.9, -12.0, 8.3},  {74.3, -13.3, 9.6},  {76.4, -12.9, 8.5},  {63.3, -10.6, 7.0},
     {71.7, -11.6, 7.6},  {77.0, -12.2, 8.0},  {65.2, -10.2, 6.7},  {47.7, -7.8, 5.2},   {68.6, -11.2, 7.4},
     {65.0, -10.4, 6.8}}};
constexpr double kD50x = 0.34567, kD50y = 0.35850;

/// Daylight of a chromaticity. [CIE 2018]
double daylight_power(const std::array<double, 3>& row, double x, double y) noexcept {
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m, m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;
  return row[0] + m1 * row[1] + m2 * row[2];
}

/// Illuminant A, 100 at 560 nm. [CIE 2018]
double illuminant_a(double lambda_nm) noexcept {
  constexpr double kSecond = 1.435e7 / 2848;  // nm
  return 100 * std::pow(560 / lambda_nm, 5) * std::expm1(kSecond / 560) / std::expm1(kSecond / lambda_nm);
}

}  // namespace

std::array<double, 3> cie_1931_xyz(double lambda_nm) noexcept {
  const CieRow row = cie_at(lambda_nm);
  return {row.x, row.y, row.z};
}

double cie_d65(double lambda_nm) noexcept {
  return cie_at(lambda_nm).d65;
}

double Illuminant::at(double lambda) const noexcept {
  if (lambda_nm.empty() || lambda < lambda_nm.front() || lambda > lambda_nm.back()) return 0;
  const auto above = static_cast<std::size_t>(std::upper_bound(lambda_nm.begin(), lambda_nm.end(), lambda) -
                                              lambda_nm.begin());
  if (above == lambda_nm.size()) return power.back();
  const double t = (lambda - lambda_nm[above - 1]) / (lambda_nm[above] - lambda_nm[above - 1]);
  return (1 - t) * power[above - 1] + t * power[above];
}

Illuminant standard_illuminant(std::string_view name) {
  Illuminant light{.name = std::string(name), .lambda_nm = {}, .power = {}};
  if (name == "D50") {
    for (std::size_t i = 0; i < kDaylight.size(); ++i) {
      light.lambda_nm.push_back(kFirst_nm + 10 * static_cast<double>(i));
      light.power.push_back(daylight_power(kDaylight[i], kD50x, kD50y));
    }
    return light;
  }
  for (int i = 0; i < kRows; ++i) {
    const double lambda = kFirst_nm + kStep_nm * i;
    light.lambda_nm.push_back(lambda);
    if (name == "E")
      light.power.push_back(1);
    else if (name == "D65")
      light.power.push_back(cie_d65(lambda));
    else if (name == "A")
      light.power.push_back(illuminant_a(lambda));
    else
      throw Error("illuminant: expected E, D50, D65, A or a file, found " + std::string(name));
  }
  return light;
}

std::vector<std::array<double, 3>> rec709_weights(std::span<const double> lambda_nm, std::string_view name) {
  return rec709_weights(lambda_nm, standard_illuminant(name));
}

std::vector<std::array<double, 3>> rec709_weights(std::span<const double> lambda_nm,
                                                  const Illuminant& illuminant) {
  const auto n = lambda_nm.size();
  if (n == 0) throw Error("wavelengths: expected at least one, found none");
  for (std::size_t k = 0; k < n; ++k)
    if (!(lambda_nm[k] > 0 && lambda_nm[k] < 1e6) || (k > 0 && lambda_nm[k] <= lambda_nm[k - 1]))
      throw Error(fmt::format("wavelengths: expected increasing nanometres below 1e6, found {} at index {}",
                              lambda_nm[k], k));

  // Between breakpoints the sample's hat function, the observer and the light are all linear.
  std::vector<double> breaks(lambda_nm.begin(), lambda_nm.end());
  for (int i = 0; i < kRows; ++i) breaks.push_back(kFirst_nm + kStep_nm * i);
  breaks.insert(breaks.end(), illuminant.lambda_nm.begin(), illuminant.lambda_nm.end());
  std::erase_if(breaks, [](double l) { return l < kFirst_nm || l > kLast_nm; });
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());

  // XYZ of every sample's hat function under the light; beyond the ends the outermost samples go on
  std::vector<Vec3> xyz(n);
  const auto add = [&](double lambda, std::size_t upper, double width) {
    const CieRow row = cie_at(lambda);
    const Vec3 v = width * illuminant.at(lambda) * Vec3{row.x, row.y, row.z};
    if (upper == 0 || upper == n) {
      xyz[std::min(upper, n - 1)] = xyz[std::min(upper, n - 1)] + v;
      return;
    }
    const double t = (lambda - lambda_nm[upper - 1]) / (lambda_nm[upper] - lambda_nm[upper - 1]);
    xyz[upper - 1] = xyz[upper - 1] + (1 - t) * v;
    xyz[upper] = xyz[upper] + t * v;
  };
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double a = breaks[i - 1], b = breaks[i], middle = 0.5 * (a + b);
    const auto upper = static_cast<std::size_t>(std::upper_bound(lambda_nm.begin(), lambda_nm.end(), middle) -
                                                lambda_nm.begin());
    // Simpson's rule, exact for the product of three linear functions.
    add(a, upper, (b - a) / 6);
    add(middle, upper, (b - a) * 4 / 6);
    add(b, upper, (b - a) / 6);
  }

  // a spectrum of ones is white
  Vec3 white;
  for (const Vec3& v : xyz) white = white + v;
  if (!(white.y > 0))
    throw Error("illuminant: expected light that is seen, found none in " + illuminant.name);
  std::vector<std::array<double, 3>> weights(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 rgb = rec709_of_xyz(adapt(xyz[k], white));
    weights[k] = {rgb.x, rgb.y, rgb.z};
  }
  return weights;
}

std::array<double, 3> rec709_of_equal_energy(const std::array<double, 3>& xyz) noexcept {
  const Vec3 rgb = rec709_of_xyz(adapt({xyz[0], xyz[1], xyz[2]}, {1, 1, 1}));
  return {rgb.x, rgb.y, rgb.z};
}

std::array<double, 4> spectrum_of_colour(std::span<const double, 3> rgb) {
  static const Matrix3 inverse = [] {
    const auto weights = rec709_weights(kColourNodes_nm, "E");
    const auto column = [&](std::size_t k) { return Vec3{weights[k][0], weights[k][1], weights[k][2]}; };
    return inverse_of_columns(column(3), column(1) + column(2), column(0));
  }();
  const Vec3 blocks = inverse * Vec3{rgb[0], rgb[1], rgb[2]};  // of long, middle and short waves
  return {blocks.z, blocks.y, blocks.y, blocks.x};
}

}  // namespace burnish
