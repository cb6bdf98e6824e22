// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/error.h>
#include <burnish/fitting/baselines/dgf_fit.h>
#include <burnish/fitting/baselines/gathered_samples.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr double kSmooth = 1e-3;  // of F and G
constexpr int kMaxD = 180, kMaxFg = 90, kMinNodes = 4;

/// The nodes of a table that a sample touches: node and node + 1, with the weight of the second.
struct Touch {
  std::uint16_t node;
  float fraction;
};

Touch touch(int count, double u) {
  const double position = std::clamp(u, 0.0, 1.0) * (count - 1);
  const int node = std::min(static_cast<int>(position), count - 2);
  return {static_cast<std::uint16_t>(node), static_cast<float>(position - node)};
}

/// The nodes that the four lookups of a sample touch, and the divisor of f.
struct Places {
  std::vector<Touch> d, f, gi, go;
  std::vector<double> divisor;
};

using Line = std::vector<double>;

double at(const Line& line, Touch t) {
  return (1 - t.fraction) * line[t.node] + t.fraction * line[t.node + 1u];
}

/// Least squares for one table, sum of weight (target - factor * line)^2, gathered sample by sample: a
/// tridiagonal system, solved for values >= 0 by coordinate descent.
class LineSystem {
 public:
  explicit LineSystem(std::size_t size) : diagonal_(size), beside_(size), right_(size) {}

  void add(Touch t, double factor, double target, double weight) {
    const double b1 = factor * t.fraction, b0 = factor - b1;
    diagonal_[t.node] += weight * b0 * b0;
    diagonal_[t.node + 1u] += weight * b1 * b1;
    beside_[t.node] += weight * b0 * b1;
    right_[t.node] += weight * b0 * target;
    right_[t.node + 1u] += weight * b1 * target;
  }

  /// With `smooth` times the mean diagonal of squared second differences added.
  void improve(Line& line, double smooth) const {
    constexpr int kSweeps = 10;
    double stiffness = 0;
    for (const double x : diagonal_) stiffness += smooth * x / static_cast<double>(diagonal_.size());
    const auto n = static_cast<std::ptrdiff_t>(line.size());
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (std::ptrdiff_t j = 0; j < n; ++j) {
        const auto k = static_cast<std::size_t>(j);
        double right = right_[k], diagonal = diagonal_[k];
        if (j > 0) right -= beside_[k - 1] * line[k - 1];
        if (j + 1 < n) right -= beside_[k] * line[k + 1];
        // the second differences about j - 1, j and j + 1 in which line[j] stands
        for (std::ptrdiff_t middle = std::max<std::ptrdiff_t>(j - 1, 1); middle <= std::min(j + 1, n - 2);
             ++middle) {
          const auto m = static_cast<std::size_t>(middle);
          const double own = middle == j ? -2 : 1;
          const double others = line[m - 1] - 2 * line[m] + line[m + 1] - own * line[k];
          right -= stiffness * own * others;
          diagonal += stiffness * own * own;
        }
        if (diagonal > 0) line[k] = std::max(0.0, right / diagonal);
      }
  }

 private:
  std::vector<double> diagonal_, beside_, right_;
};

/// One channel's model and its data.
class ChannelFit {
 public:
  ChannelFit(const GatheredSamples& samples, const Places& places, std::size_t channel, std::size_t size_d,
             std::size_t size_fg)
      : samples_(samples), places_(places), channel_(channel), d(size_d), g(size_fg), f(size_fg, 1.0) {
    weights_ = compressive_weights(samples, channel);
    for (std::size_t j = 0; j < size_fg; ++j)
      g[j] = std::sqrt(std::cos(kHalfPi * static_cast<double>(j) / static_cast<double>(size_fg)));
    // a dark fifth of the values is taken for diffuse, the rest for D
    std::vector<double> values;
    for (std::size_t i = 0; i < samples.size(); ++i) values.push_back(target(i));
    const auto fifth = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 5);
    std::nth_element(values.begin(), fifth, values.end());
    diffuse = std::max(*fifth, 0.0);
    update_d();
    for (double& x : d) x = std::max(x, 1e-6);
  }

  void round() {
    update_d();
    LineSystem for_f(f.size());
    for (std::size_t i = 0; i < samples_.size(); ++i)
      for_f.add(places_.f[i], at(d, places_.d[i]) * masking(i), specular_target(i), weights_[i]);
    for_f.improve(f, kSmooth);
    // each use of G in turn, the other held, and the mean of before and after against swinging
    LineSystem for_g(g.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double rest = at(d, places_.d[i]) * at(f, places_.f[i]) / places_.divisor[i];
      for_g.add(places_.gi[i], rest * at(g, places_.go[i]), specular_target(i), weights_[i]);
      for_g.add(places_.go[i], rest * at(g, places_.gi[i]), specular_target(i), weights_[i]);
    }
    Line improved = g;
    for_g.improve(improved, kSmooth);
    for (std::size_t j = 0; j < g.size(); ++j) g[j] = 0.5 * (g[j] + improved[j]);
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      sum += weights_[i] * (target(i) - specular(i));
      weight += weights_[i];
    }
    diffuse = std::max(0.0, sum / weight);
    normalize();
  }

  double error() const {
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double e = target(i) - diffuse - specular(i);
      sum += weights_[i] * e * e;
    }
    return sum;
  }

 private:
  double target(std::size_t i) const { return samples_.values[i * samples_.channels + channel_]; }
  double specular_target(std::size_t i) const { return target(i) - diffuse; }
  double masking(std::size_t i) const {
    return at(g, places_.gi[i]) * at(g, places_.go[i]) / places_.divisor[i];
  }
  double specular(std::size_t i) const { return at(d, places_.d[i]) * at(f, places_.f[i]) * masking(i); }

  void update_d() {
    LineSystem system(d.size());
    for (std::size_t i = 0; i < samples_.size(); ++i)
      system.add(places_.d[i], at(f, places_.f[i]) * masking(i), specular_target(i), weights_[i]);
    system.improve(d, 0);
  }

  // The largest value of F and G is 1; D carries the rest.
  void normalize() {
    const double most_f = *std::max_element(f.begin(), f.end()),
                 most_g = *std::max_element(g.begin(), g.end());
    if (most_f <= 0 || most_g <= 0) return;
    for (double& x : f) x /= most_f;
    for (double& x : g) x /= most_g;
    for (double& x : d) x *= most_f * most_g * most_g;
  }

  const GatheredSamples& samples_;
  const Places& places_;
  std::size_t channel_;
  std::vector<double> weights_;

 public:
  double diffuse = 0;
  Line d, g, f;
};

/// Returns the places of the samples in tables of these sizes.
Places places_in(const GatheredSamples& samples, int size_d, int size_fg) {
  Places places;
  for (const auto& [wi, wo] : samples.pairs) {
    const PairPlace place(wi, wo);
    places.d.push_back(touch(size_d, place[PairCoordinate::theta_h]));
    places.f.push_back(touch(size_fg, place[PairCoordinate::theta_d]));
    places.gi.push_back(touch(size_fg, masking_place(wi)[PairCoordinate::theta_d]));
    places.go.push_back(touch(size_fg, masking_place(wo)[PairCoordinate::theta_d]));
    places.divisor.push_back(microfacet_divisor(wi, wo));
  }
  return places;
}

NodeTable make_table(PairCoordinate coordinate, std::size_t count, std::size_t channels) {
  NodeTable table{{{coordinate, static_cast<int>(count)}}, channels, 1, {}};
  table.values.resize(count * channels);
  return table;
}

}  // namespace

DgfFit fit_dgf(const SampleSource& source, const DgfOptions& options) {
  if (!source.isotropic) throw Error("dgf: expected an isotropic source, found an anisotropic one");
  const auto channels = source.channels;
  const auto nodes =
      static_cast<int>((options.budget / channels - std::min<std::size_t>(options.budget / channels, 8)) / 2);
  const int size_d = std::min(kMaxD, nodes / 2), size_fg = std::min(kMaxFg, (nodes - size_d) / 2);
  if (size_fg < kMinNodes || size_d < kMinNodes)
    throw Error(fmt::format("dgf: expected a budget of at least {} bytes, found {}",
                            channels * (8 + 8 * kMinNodes), options.budget));

  const GatheredSamples samples = gather_samples(source, options.most_samples);
  const Places places = places_in(samples, size_d, size_fg);

  // a channel at a time, stored as half floats over the largest D
  NodeTable d = make_table(PairCoordinate::theta_h, static_cast<std::size_t>(size_d), channels),
            g = make_table(PairCoordinate::theta_d, static_cast<std::size_t>(size_fg), channels), f = g;
  std::vector<float> diffuse(channels), scale(channels);
  std::vector<std::array<double, 2>> errors(channels);
  for_each_chunk(channels, 1, [&](std::size_t c, std::size_t, std::size_t) {
    ChannelFit fit(samples, places, c, static_cast<std::size_t>(size_d), static_cast<std::size_t>(size_fg));
    errors[c][0] = fit.error();
    for (int round = 0; round < options.rounds; ++round) {
      fit.round();
      if (c == 0 && options.progress) options.progress(static_cast<double>(round + 1) / options.rounds);
    }
    errors[c][1] = fit.error();
    diffuse[c] = static_cast<float>(fit.diffuse);
    const double most = *std::max_element(fit.d.begin(), fit.d.end());
    scale[c] = static_cast<float>(most);
    const auto store = [&](const Line& line, double unit, NodeTable& table) {
      for (std::size_t j = 0; j < line.size(); ++j)
        table.values[j * channels + c] = round_to_half(unit > 0 ? line[j] / unit : 0);
    };
    store(fit.d, most, d);
    store(fit.g, 1, g);
    store(fit.f, 1, f);
  });
  double before = 0, after = 0;
  for (const auto& [first, last] : errors) {
    before += first / static_cast<double>(channels);
    after += last / static_cast<double>(channels);
  }
  return {DgfBrdf(std::move(diffuse), std::move(scale), std::move(d), std::move(g), std::move(f)),
          {.error_before = before, .error_after = after, .iterations = options.rounds}};
}

}  // namespace burnish
