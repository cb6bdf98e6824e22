// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/sphere_images.h>

namespace burnish {
namespace {

constexpr Vec3 kView{0, 0, 1};

void check_size(int size) {
  constexpr int kMin = 16, kMax = 8192;
  if (size < kMin || size > kMax)
    throw Error(fmt::format("expected a sphere image of {} to {} pixels, found {}", kMin, kMax, size));
}

// Tangent and bitangent at a normal of the sphere.
std::array<Vec3, 2> tangents(Vec3 n) noexcept {
  const Vec3 t = normalize(cross(Vec3{0, 1, 0}, n));
  return {t, cross(n, t)};
}

Vec3 light_direction(double angle) noexcept {
  return {std::sin(angle), 0, std::cos(angle)};
}

std::size_t as_size(int v) noexcept {
  return static_cast<std::size_t>(v);
}

// f_r max(cos theta_i, 0) at normals of the sphere, many at a time.
class Shading {
 public:
  Shading(BrdfRef brdf, Vec3 light) : brdf_(brdf), light_(light) {}

  void run(std::span<const Vec3> normals) {
    pairs_.clear();
    for (const Vec3 n : normals) pairs_.push_back({sphere_local(n, light_), sphere_local(n, kView)});
    values_.resize(pairs_.size() * channels());
    known_.resize(pairs_.size());
    brdf_.eval(pairs_, values_, known_);
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] *= std::max(pairs_[i / channels()].wi.z, 0.0);
  }
  // Returns the value at normal i of the last run.
  std::span<const double> value(std::size_t i) const noexcept {
    return std::span(values_).subspan(i * channels(), channels());
  }
  std::uint8_t known(std::size_t i) const noexcept { return known_[i]; }

 private:
  std::size_t channels() const noexcept { return as_size(brdf_.channels()); }

  BrdfRef brdf_;
  Vec3 light_;
  std::vector<DirectionPair> pairs_;
  std::vector<double> values_;
  std::vector<std::uint8_t> known_;
};

// Channels two images are compared in.
std::size_t common_channels(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height)
    throw Error(fmt::format("cannot compare an image of {} x {} with one of {} x {}", a.width, a.height,
                            b.width, b.height));
  if (a.channels != b.channels && a.channels != 1 && b.channels != 1)
    throw Error(fmt::format("cannot compare {} channels with {}", a.channels, b.channels));
  return std::max(a.channels, b.channels);
}

double channel(const Image& image, int x, int y, std::size_t c) noexcept {
  return image.at(x, y)[image.channels == 1 ? 0 : as_size(c)];
}

}  // namespace

std::optional<Vec3> sphere_normal(int size, double x, double y) noexcept {
  const double radius = size / 2.0, nx = x / radius - 1, ny = 1 - y / radius, z2 = 1 - nx * nx - ny * ny;
  if (z2 <= 0) return std::nullopt;
  return Vec3{nx, ny, std::sqrt(z2)};
}

Vec3 sphere_local(Vec3 n, Vec3 w) noexcept {
  const auto [t, s] = tangents(n);
  return {dot(w, t), dot(w, s), dot(w, n)};
}

LitSphere render_sphere(BrdfRef brdf, double light_angle, int size) {
  check_size(size);
  LitSphere sphere{Image(size, size, brdf.channels()),
                   std::vector<std::uint8_t>(as_size(size) * as_size(size), 1)};
  const Vec3 light = light_direction(light_angle);
  for_each_chunk(as_size(size), 8, [&](std::size_t, std::size_t begin, std::size_t end) {
    Shading shading(brdf, light);
    std::vector<int> columns;
    std::vector<Vec3> normals;
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      columns.clear();
      normals.clear();
      for (int x = 0; x < size; ++x)
        if (const auto n = sphere_normal(size, x + 0.5, y + 0.5)) {
          columns.push_back(x);
          normals.push_back(*n);
        }
      shading.run(normals);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        sphere.known[row * as_size(size) + as_size(columns[i])] = shading.known(i);
        std::ranges::copy(shading.value(i), sphere.image.at(columns[i], y).begin());
      }
    }
  });
  return sphere;
}

Image render_dome(BrdfRef brdf, int size) {
  check_size(size);
  constexpr int kThetas = 48, kAzimuths = 48, kGrid = 64;
  const int azimuths = brdf.isotropic() ? 1 : kAzimuths;
  const std::size_t channels = as_size(brdf.channels());
  const auto node = [&](int theta, int phi) { return as_size(theta * azimuths + phi) * channels; };

  // albedo towards every node; the last row is just above the horizon
  std::vector<double> albedo(as_size(kThetas * azimuths) * channels);
  for_each_chunk(as_size(kThetas * azimuths), 1, [&](std::size_t index, std::size_t, std::size_t) {
    const int i = static_cast<int>(index) / azimuths, j = static_cast<int>(index) % azimuths;
    constexpr double kLastTheta = kHalfPi * 0.999;
    const Vec3 wo = spherical_direction(kLastTheta * i / (kThetas - 1), kTwoPi * j / azimuths);
    std::vector<double> f(channels);
    for (int a = 0; a < kGrid; ++a) {
      // theta_h = pi/2 u^2, so that d omega_h = sin(theta_h) pi u du dphi
      const double u = (a + 0.5) / kGrid, theta_h = kHalfPi * u * u;
      const double d_omega_h = std::sin(theta_h) * kPi * u * (1.0 / kGrid) * (kTwoPi / kGrid);
      for (int b = 0; b < kGrid; ++b) {
        const Vec3 h = spherical_direction(theta_h, kTwoPi * (b + 0.5) / kGrid);
        const double cos_d = dot(wo, h);
        const Vec3 wi = 2 * cos_d * h - wo;
        if (cos_d <= 0 || wi.z <= 0) continue;
        brdf.eval(wi, wo, f);
        const double weight = wi.z * 4 * cos_d * d_omega_h;  // d omega_i = 4 cos theta_d d omega_h
        for (std::size_t c = 0; c < channels; ++c) albedo[node(i, j) + c] += weight * f[c];
      }
    }
  });

  // every pixel: bilinear between the nodes
  Image image(size, size, brdf.channels());
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto n = sphere_normal(size, x + 0.5, y + 0.5);
      if (!n) continue;
      const Vec3 wo = sphere_local(*n, kView);
      const double row = std::min(theta_of(wo) / kHalfPi * (kThetas - 1), kThetas - 1.0);
      const double column = phi_of(wo) / kTwoPi * azimuths;
      const int i = std::min(static_cast<int>(row), kThetas - 2), j = static_cast<int>(column) % azimuths;
      const double s = row - i, t = azimuths == 1 ? 0 : column - std::floor(column);
      const int next = (j + 1) % azimuths;
      for (std::size_t c = 0; c < channels; ++c)
        image.at(x, y)[c] = static_cast<float>(
            (1 - s) * ((1 - t) * albedo[node(i, j) + c] + t * albedo[node(i, next) + c]) +
            s * ((1 - t) * albedo[node(i + 1, j) + c] + t * albedo[node(i + 1, next) + c]));
    }
  return image;
}

double percentile(std::vector<float> values, double fraction) {
  if (values.empty()) throw Error("a percentile needs at least one value");
  const double place = fraction * static_cast<double>(values.size() - 1);
  const auto index = static_cast<std::ptrdiff_t>(place);
  const auto low = values.begin() + index;
  std::nth_element(values.begin(), low, values.end());
  if (low + 1 == values.end()) return *low;
  const double next = *std::min_element(low + 1, values.end());
  return *low + (place - static_cast<double>(index)) * (next - *low);
}

double sphere_exposure(std::span<const LitSphere> spheres) {
  std::vector<float> values;
  for (const LitSphere& sphere : spheres)
    for (int y = 0; y < sphere.image.height; ++y)
      for (int x = 0; x < sphere.image.width; ++x)
        if (sphere_normal(sphere.image.width, x + 0.5, y + 0.5)) {
          const auto pixel = sphere.image.at(x, y);
          values.insert(values.end(), pixel.begin(), pixel.end());
        }
  constexpr double kWhiteShare = 0.97;
  double white = percentile(values, kWhiteShare);
  if (!(white > 0)) white = *std::ranges::max_element(values);
  return white > 0 ? 1 / white : 1;
}

Image tone_map(Image image, double exposure) {
  constexpr double kGamma = 2.2;
  for (float& value : image.pixels)
    value = static_cast<float>(std::pow(std::clamp(exposure * value, 0.0, 1.0), 1 / kGamma));
  return image;
}

double mean_squared_error(const Image& a, const Image& b) {
  const std::size_t channels = common_channels(a, b);
  double sum = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (std::size_t c = 0; c < channels; ++c) {
        const double difference = channel(a, x, y, c) - channel(b, x, y, c);
        sum += difference * difference;
      }
  return sum / (static_cast<double>(a.width) * a.height * static_cast<double>(channels));
}

double psnr(double mean_squared_error) noexcept {
  return mean_squared_error > 0 ? -10 * std::log10(mean_squared_error)
                                : std::numeric_limits<double>::infinity();
}

double ssim(const Image& a, const Image& b) {
  constexpr int kRadius = 6, kWindow = 2 * kRadius + 1;
  constexpr double kSigma = 1.5, kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  const std::size_t channels = common_channels(a, b);
  const int width = a.width, height = a.height;
  if (std::min(width, height) < kRadius)
    throw Error(fmt::format("SSIM needs an image of at least {0} x {0} pixels", kRadius));

  // a Gaussian window
  std::array<double, kWindow> window;
  double total = 0;
  for (int i = 0; i < kWindow; ++i) {
    const double d = (i - kRadius) / kSigma;
    window[as_size(i)] = std::exp(-d * d / 2);
    total += window[as_size(i)];
  }
  for (double& w : window) w /= total;
  // beyond an edge the image goes on as its mirror image, the edge pixel twice
  const auto mirrored = [](int i, int size) { return i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i; };

  // weighted moments a, b, aa, bb, ab: along the rows, then along the columns
  using Moments = std::array<double, 5>;
  std::vector<double> row_sums(as_size(height * channels));
  for_each_chunk(as_size(channels), 1, [&](std::size_t index, std::size_t, std::size_t) {
    const int c = static_cast<int>(index);
    std::vector<Moments> along(as_size(width) * as_size(height));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        Moments& m = along[as_size(y) * as_size(width) + as_size(x)];
        for (int k = 0; k < kWindow; ++k) {
          const int from = mirrored(x + k - kRadius, width);
          const double u = channel(a, from, y, c), v = channel(b, from, y, c), w = window[as_size(k)];
          const Moments terms = {u, v, u * u, v * v, u * v};
          for (std::size_t i = 0; i < m.size(); ++i) m[i] += w * terms[i];
        }
      }
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        Moments m{};
        for (int k = 0; k < kWindow; ++k) {
          const Moments& part =
              along[as_size(mirrored(y + k - kRadius, height)) * as_size(width) + as_size(x)];
          for (std::size_t i = 0; i < m.size(); ++i) m[i] += window[as_size(k)] * part[i];
        }
        const double ab = m[0] * m[1], squares = m[0] * m[0] + m[1] * m[1];
        // [Wang 2004, eq. 13]
        row_sums[index * as_size(height) + as_size(y)] +=
            (2 * ab + kC1) * (2 * (m[4] - ab) + kC2) / ((squares + kC1) * (m[2] + m[3] - squares + kC2));
      }
  });
  double sum = 0;
  for (const double row : row_sums) sum += row;
  return sum / (static_cast<double>(width) * height * channels);
}

Image8 to_image8(const Image& shown) {
  Image8 bytes(shown.width, shown.height, 3);
  const auto to_byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
  };
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      const auto from = shown.at(x, y);
      const auto to = bytes.at(x, y);
      if (shown.channels == 3) {
        std::ranges::transform(from, to.begin(), to_byte);
        continue;
      }
      double mean = 0;
      for (const float value : from) mean += value;
      std::ranges::fill(to, to_byte(mean / shown.channels));
    }
  return bytes;
}

namespace {

// The exposure of the three lights together.
double metered_exposure(BrdfRef brdf) {
  constexpr int kMeterSize = 128;
  std::vector<LitSphere> spheres;
  for (const double light : kSphereLights) spheres.push_back(render_sphere(brdf, light, kMeterSize));
  return sphere_exposure(spheres);
}

// A lit sphere, linear, and how much of each pixel it covers.
struct SmoothSphere {
  Image shown, coverage;
};

// Light is averaged after clamping, so that the edge of a highlight is smooth too.
SmoothSphere smooth_sphere(BrdfRef brdf, double exposure, const LitSphereOptions& options) {
  const int samples = options.supersampling;
  const Vec3 light = light_direction(options.light_angle);
  SmoothSphere sphere{Image(options.size, options.size, brdf.channels()),
                      Image(options.size, options.size, 1)};
  for_each_chunk(as_size(options.size), 8, [&](std::size_t, std::size_t begin, std::size_t end) {
    Shading shading(brdf, light);
    std::vector<int> hits(as_size(options.size));  // of each pixel of a row
    std::vector<Vec3> normals;
    std::vector<double> sum(as_size(brdf.channels()));
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      std::ranges::fill(hits, 0);
      normals.clear();
      for (int x = 0; x < options.size; ++x)
        for (int k = 0; k < samples * samples; ++k)
          if (const auto n = sphere_normal(options.size, x + (k % samples + 0.5) / samples,
                                           y + (k / samples + 0.5) / samples)) {
            ++hits[as_size(x)];
            normals.push_back(*n);
          }
      shading.run(normals);
      std::size_t next = 0;
      for (int x = 0; x < options.size; ++x) {
        const int count = hits[as_size(x)];
        if (count == 0) continue;
        std::ranges::fill(sum, 0.0);
        for (int k = 0; k < count; ++k, ++next)
          for (std::size_t c = 0; c < sum.size(); ++c)
            sum[c] += std::clamp(exposure * shading.value(next)[c], 0.0, 1.0);
        for (std::size_t c = 0; c < sum.size(); ++c)
          sphere.shown.at(x, y)[c] = static_cast<float>(sum[c] / count);
        sphere.coverage.at(x, y)[0] = static_cast<float>(count) / static_cast<float>(samples * samples);
      }
    }
  });
  return sphere;
}

}  // namespace

Image8 lit_sphere(BrdfRef brdf, const LitSphereOptions& options) {
  check_size(options.size);
  if (options.supersampling < 1 || options.supersampling > 16)
    throw Error(fmt::format("expected a supersampling of 1 to 16, found {}", options.supersampling));
  const double exposure = options.exposure ? *options.exposure : metered_exposure(brdf);
  SmoothSphere sphere = smooth_sphere(brdf, exposure, options);

  // tone mapped, with the coverage as alpha
  const Image8 opaque = to_image8(tone_map(std::move(sphere.shown), 1));
  Image8 picture(options.size, options.size, 4);
  for (int y = 0; y < options.size; ++y)
    for (int x = 0; x < options.size; ++x) {
      std::ranges::copy(opaque.at(x, y), picture.at(x, y).begin());
      picture.at(x, y)[3] = static_cast<std::uint8_t>(std::lround(255 * sphere.coverage.at(x, y)[0]));
    }
  return picture;
}

}  // namespace burnish
