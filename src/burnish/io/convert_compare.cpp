// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <burnish/io/convert_compare.h>
#include <burnish/math/luminance.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/reflectance/statistics.h>

namespace burnish {

namespace {

constexpr double kComparedFloor = 1e-3;  // as in error_figures.h

}  // namespace

bool Luminance::eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept {
  if (source.channels() == 1) return source.eval(wi, wo, f);
  std::array<double, 3> rgb;
  const bool known = source.eval(wi, wo, rgb);
  f[0] = luminance({rgb[0], rgb[1], rgb[2]});
  return known;
}

std::optional<double> relative_difference(BrdfRef a, BrdfRef b, std::size_t count) {
  const auto channels_a = a.channels(), channels_b = b.channels();
  const std::vector<DirectionPair> pairs = draw_pairs(count, 1, a.isotropic() && b.isotropic());
  std::vector<double> f(pairs.size() * channels_a), g(pairs.size() * channels_b);
  std::vector<std::uint8_t> known_a(pairs.size()), known_b(pairs.size());
  a.eval(pairs, f, known_a);
  b.eval(pairs, g, known_b);

  double sum = 0;
  std::size_t terms = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!known_a[i] || !known_b[i]) continue;
    const std::size_t channels = std::max(channels_a, channels_b);
    for (std::size_t c = 0; c < channels; ++c, ++terms) {
      const auto value = [i, c](const std::vector<double>& v, std::size_t size) {
        return std::max(v[i * size + (size == 1 ? 0 : c)], 0.0);
      };
      sum += std::abs(
          std::log((value(f, channels_a) + kComparedFloor) / (value(g, channels_b) + kComparedFloor)));
    }
  }
  if (terms == 0) return std::nullopt;
  return std::expm1(sum / static_cast<double>(terms));
}

bool has_colour(BrdfRef brdf) {
  const auto channels = brdf.channels();
  if (channels == 1) return false;
  const std::vector<DirectionPair> pairs = draw_pairs(kComparedPairs, 1, brdf.isotropic());
  std::vector<double> f(pairs.size() * channels);
  std::vector<std::uint8_t> known(pairs.size());
  brdf.eval(pairs, f, known);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!known[i]) continue;
    const auto values = std::span(f).subspan(i * channels, channels);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (*most - *least > 1e-6 * std::abs(*most)) return true;
  }
  return false;
}

std::string sample_name(const Source& source) {
  return source.findings.description.empty() ? std::filesystem::path(source.name).filename().string()
                                             : source.findings.description;
}

}  // namespace burnish
