// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/lighting/area_light_fit.h>
#include <burnish/lighting/node_fit.h>
#include <burnish/math/angles.h>
#include <burnish/math/random.h>

namespace burnish {

namespace {

constexpr double kPull = 1e-2;  // 1e-3 leaves lobes that jump between nodes

void check(BrdfRef brdf, const AreaLightFitOptions& options) {
  if (brdf.channels() != 1 && brdf.channels() != 3)
    throw Error(fmt::format("area lights: expected a BRDF of 1 or 3 channels, found {}", brdf.channels()));
  const auto in = [](const char* what, std::size_t value, std::size_t least, std::size_t most) {
    if (value < least || value > most)
      throw Error(fmt::format("area lights: expected {} in [{}, {}], found {}", what, least, most, value));
  };
  in("lobes", options.lobes, 1, AreaLightTable::kMaxLobes);
  in("thetas", options.thetas, 4, 256);
  in("polars", options.polars, 4, 256);
  in("quarter", options.quarter, 2, 64);
  if (options.iterations < 1)
    throw Error(fmt::format("area lights: expected iterations >= 1, found {}", options.iterations));
}

// True if the mean difference from the mirror image along x is small relative to the mean.
bool is_mirror_image(BrdfRef brdf) {
  Pcg32 random(5);
  std::vector<double> f(brdf.channels()), g(brdf.channels());
  const auto flip = [](Vec3 w) { return Vec3{-w.x, w.y, w.z}; };
  double gap = 0, sum = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto draw = [&] {
      const double u = random.uniform(), phi = kTwoPi * random.uniform();
      return spherical_direction(std::acos(std::sqrt(1 - 0.98 * u)), phi);
    };
    const Vec3 wi = draw(), wo = draw();
    brdf.eval(wi, wo, f);
    brdf.eval(flip(wi), flip(wo), g);
    for (std::size_t c = 0; c < f.size(); ++c) {
      gap += std::abs(std::sqrt(f[c]) - std::sqrt(g[c]));
      sum += std::sqrt(f[c]);
    }
  }
  return gap <= 0.02 * sum;
}

AreaLightViews views_of(BrdfRef brdf) {
  if (brdf.isotropic()) return AreaLightViews::line;
  return is_mirror_image(brdf) ? AreaLightViews::quarter : AreaLightViews::full;
}

Vec3 node_view(const AreaLightTable& table, std::size_t azimuth, std::size_t theta) {
  const double u = static_cast<double>(theta) / static_cast<double>(table.thetas - 1);
  const double polar = std::min(2 * std::atan(u), kLastTheta);
  if (table.azimuths == 1) return spherical_direction(polar, 0);
  const double quarters = table.views == AreaLightViews::quarter ? 1 : 4;
  const double at = quarters * static_cast<double>(azimuth) / static_cast<double>(table.azimuths - 1);
  const double whole = std::min(std::floor(at), quarters - 1), part = at - whole;
  return spherical_direction(polar, whole * kHalfPi + std::atan2(part, 1 - part));
}

class TableFit {
 public:
  TableFit(BrdfRef brdf, const AreaLightFitOptions& options) : options_(options) {
    table_.views = views_of(brdf);
    table_.thetas = table_.views == AreaLightViews::line ? options.thetas : options.polars;
    if (table_.views == AreaLightViews::quarter) table_.azimuths = options.quarter;
    if (table_.views == AreaLightViews::full) table_.azimuths = 4 * (options.quarter - 1) + 1;
    mirrored_ = table_.views == AreaLightViews::line;
    for (std::size_t a = 0; a < table_.azimuths; ++a)
      for (std::size_t t = 0; t < table_.thetas; ++t) {
        const Vec3 wo = node_view(table_, a, t);
        targets_.push_back(node_target(brdf, wo, table_.views, mirrored_));
        const auto [x, y, z] = mirrored_view(wo, table_.views);
        axes_.push_back({Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}});
      }
    nodes_.resize(targets_.size());
    share_whites();
  }

  AreaLightTable run() {
    const std::size_t middle = table_.thetas / 3;
    nodes_[middle] = best_start(middle);
    for (std::size_t t = middle + 1; t < table_.thetas; ++t) advance(t, t - 1);
    for (std::size_t t = middle; t-- > 0;) advance(t, t + 1);
    // Azimuths follow one after another. Views along the normal are the same, but turned.
    for (std::size_t a = 1; a < table_.azimuths; ++a) {
      nodes_[at(a, 0)] = turned(nodes_[0], phi_of(node_view(table_, a, 1)));
      for (std::size_t t = 1; t < table_.thetas; ++t) advance(at(a, t), at(a - 1, t));
    }
    for (int sweep = 0; sweep < 2; ++sweep) smooth();
    return finish();
  }

 private:
  std::size_t at(std::size_t azimuth, std::size_t theta) const { return azimuth * table_.thetas + theta; }
  NodeFitOptions node_options(double pull) const {
    return {.mirrored = mirrored_,
            .with_cosine = options_.with_cosine,
            .iterations = options_.iterations,
            .pull = pull};
  }
  void told() {
    done_ += 1;
    if (options_.progress)
      options_.progress(std::min(1.0, done_ / (3.0 * static_cast<double>(nodes_.size()))));
  }

  // All views share one exposure: the median over those away from the horizon.
  void share_whites() {
    for (std::size_t size = 0; size < kTrialSizes.size(); ++size) {
      std::vector<double> whites;
      for (std::size_t i = 0; i < targets_.size(); ++i)
        if (3 * (i % table_.thetas) < 2 * table_.thetas) whites.push_back(targets_[i].white[size]);
      std::ranges::nth_element(whites, whites.begin() + static_cast<std::ptrdiff_t>(whites.size() / 2));
      for (NodeTarget& target : targets_) target.white[size] = whites[whites.size() / 2];
    }
  }

  // Finds the best of several starts with random widths and tilts. A few steps from each tell which one to continue.
  NodeLobes best_start(std::size_t node) const {
    const NodeTarget& target = targets_[node];
    constexpr int kStarts = 24;
    Pcg32 random(11);
    std::vector<std::pair<double, NodeLobes>> found;
    for (int start = 0; start < kStarts; ++start) {
      NodeLobes trial;
      for (std::size_t c = 0; c < target.channels; ++c)
        trial.cosine[c] = options_.with_cosine ? 0.2 * target.albedo[c] : 0;
      for (std::size_t j = 0; j < options_.lobes; ++j) {
        const double width = 0.01 * std::pow(150.0, random.uniform()),
                     tilt = j == 0 ? 0 : 0.6 * (random.uniform() - 0.5);
        NodeLobes::Lobe& lobe = trial.lobes.emplace_back();
        lobe.inverse = {std::cos(tilt) / width, 0, std::sin(tilt) / width, 0, 1 / width, 0,
                        -std::sin(tilt),        0, std::cos(tilt)};
        for (std::size_t c = 0; c < target.channels; ++c)
          lobe.amplitude[c] = 0.6 * target.albedo[c] / static_cast<double>(options_.lobes);
      }
      NodeFitOptions few = node_options(0);
      few.iterations = 12;
      const double loss = fit_node(target, axes_[node], trial, nullptr, few);
      found.emplace_back(loss, std::move(trial));
    }
    std::ranges::stable_sort(found, {}, [](const auto& one) { return one.first; });
    found.resize(4);
    for (auto& [loss, trial] : found) loss = fit_node(target, axes_[node], trial, nullptr, node_options(0));
    return std::ranges::min_element(found, {}, [](const auto& one) { return one.first; })->second;
  }

  void advance(std::size_t node, std::size_t from) {
    nodes_[node] = nodes_[from];
    fit_node(targets_[node], axes_[node], nodes_[node], &nodes_[from], node_options(kPull));
    told();
  }

  // Refits each node with a pull towards the mean of its neighbours along theta_o.
  void smooth() {
    for (std::size_t a = 0; a < table_.azimuths; ++a)
      for (std::size_t t = table_.azimuths > 1 ? 1 : 0; t < table_.thetas; ++t) {
        NodeLobes near = t == 0 ? nodes_[at(a, 1)] : nodes_[at(a, t - 1)];
        if (t > 0 && t + 1 < table_.thetas) near = between(near, nodes_[at(a, t + 1)]);
        fit_node(targets_[at(a, t)], axes_[at(a, t)], nodes_[at(a, t)], &near, node_options(kPull));
        told();
      }
  }

  static NodeLobes between(NodeLobes a, const NodeLobes& b) {
    for (std::size_t c = 0; c < 3; ++c) a.cosine[c] = 0.5 * (a.cosine[c] + b.cosine[c]);
    for (std::size_t j = 0; j < a.lobes.size(); ++j) {
      for (std::size_t k = 0; k < 9; ++k)
        a.lobes[j].inverse[k] = 0.5 * (a.lobes[j].inverse[k] + b.lobes[j].inverse[k]);
      for (std::size_t c = 0; c < 3; ++c)
        a.lobes[j].amplitude[c] = 0.5 * (a.lobes[j].amplitude[c] + b.lobes[j].amplitude[c]);
    }
    return a;
  }

  // Returns the lobes of a view along the normal, in a frame whose x lies at azimuth phi.
  static NodeLobes turned(NodeLobes node, double phi) {
    const double c = std::cos(phi), s = std::sin(phi);
    for (NodeLobes::Lobe& lobe : node.lobes) {
      auto b = lobe.inverse;
      // Columns are turned, then rows. Turning rows does not change the lobe, but keeps the matrix near its
      // neighbours.
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = b[3 * i], y = b[3 * i + 1];
        b[3 * i] = c * x + s * y;
        b[3 * i + 1] = c * y - s * x;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = b[k], y = b[3 + k];
        b[k] = c * x + s * y;
        b[3 + k] = c * y - s * x;
      }
      lobe.inverse = b;
    }
    return node;
  }

  // Rounds matrices before heights are scaled, so that albedos belong to the stored values.
  AreaLightTable finish() {
    table_.lobes.resize(options_.lobes);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      NodeLobes& node = nodes_[i];
      for (NodeLobes::Lobe& lobe : node.lobes)
        for (double& b : lobe.inverse) b = static_cast<double>(static_cast<float>(b));
      const Vec3 wo = node_view(table_, i / table_.thetas, i % table_.thetas);
      conserve_albedo(targets_[i], node, wo, table_.views);
      const auto add = [&](std::vector<float>& to, const std::array<double, 3>& color) {
        for (std::size_t c = 0; c < 3; ++c)
          to.push_back(static_cast<float>(color[targets_[i].channels == 1 ? 0 : c]));
      };
      add(table_.cosine, node.cosine);
      for (std::size_t j = 0; j < options_.lobes; ++j) {
        for (const double b : node.lobes[j].inverse) table_.lobes[j].inverse.push_back(static_cast<float>(b));
        add(table_.lobes[j].amplitude, node.lobes[j].amplitude);
      }
    }
    return std::move(table_);
  }

  AreaLightFitOptions options_;
  AreaLightTable table_;
  bool mirrored_ = true;
  std::vector<NodeTarget> targets_;
  std::vector<std::array<Vec3, 3>> axes_;  // see fit_node
  std::vector<NodeLobes> nodes_;
  double done_ = 0;
};

}  // namespace

AreaLightTable fit_area_lights(BrdfRef brdf, const AreaLightFitOptions& options) {
  check(brdf, options);
  return TableFit(brdf, options).run();
}

}  // namespace burnish
