// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/power/cosine.h>
#include <burnish/report/specular_figures.h>

namespace burnish {
namespace {

constexpr int kSamples = 600;

void require_some(std::size_t count, const char* what) {
  if (count == 0) throw Error(fmt::format("specular figure: expected at least one {}", what));
}

// Angles in degrees up to where cos^exponent is 1/1000.
std::vector<double> angles_of(double exponent) {
  const double end = degrees(std::acos(std::pow(1e-3, 1 / exponent)));
  std::vector<double> angles(kSamples + 1);
  for (int i = 0; i <= kSamples; ++i) angles[static_cast<std::size_t>(i)] = end * i / kSamples;
  return angles;
}

// Returns the value, or not-a-number outside the range, so that it is left out of the drawing.
double within(double value, double low, double high) {
  return value >= low && value <= high ? value : std::nan("");
}

template <class F>
std::vector<double> mapped(const std::vector<double>& x, F f) {
  std::vector<double> y;
  y.reserve(x.size());
  for (double v : x) y.push_back(f(v));
  return y;
}

double cosine_of(double angle_deg) {
  return std::clamp(std::cos(radians(angle_deg)), 0.0, 1.0);
}

std::string label_of(PowerMethod method, double exponent, std::size_t exponents) {
  const auto name = power_info(method).name;
  return exponents > 1 ? fmt::format("{}, e = {}", name, exponent) : std::string(name);
}

}  // namespace

Plot lobe_figure(std::span<const PowerMethod> methods, std::span<const double> exponents) {
  require_some(exponents.size(), "exponent");
  Plot plot;
  plot.title = exponents.size() == 1 ? fmt::format("cos(γ)^{} and its approximations", exponents[0])
                                     : "cos(γ)^e and its approximations";
  plot.x_label = "γ (degrees)";
  plot.y_label = "lobe";
  for (double e : exponents) {
    const std::vector<double> angles = angles_of(e);
    plot.series.push_back({fmt::format("cos^{}", e), angles,
                           mapped(angles, [&](double a) { return std::pow(cosine_of(a), e); }),
                           PlotStyle::line});
    for (PowerMethod method : methods) {
      const PowerCoefficients k = power_coefficients(method, e);
      plot.series.push_back(
          {label_of(method, e, exponents.size()), angles,
           mapped(angles, [&](double a) { return within(power(k, cosine_of(a)), -0.2, 1.2); }),
           PlotStyle::dashed});
    }
  }
  return plot;
}

Plot relative_error_figure(std::span<const PowerMethod> methods, std::span<const double> exponents,
                           double limit) {
  require_some(exponents.size(), "exponent");
  require_some(methods.size(), "method");
  Plot plot;
  plot.title = "relative error of the approximation";
  plot.x_label = "γ (degrees)";
  plot.y_label = "approximation / cos(γ)^e − 1 (%)";
  plot.y_min = -limit;
  plot.y_max = limit;
  for (double e : exponents) {
    const std::vector<double> angles = angles_of(e);
    for (PowerMethod method : methods) {
      const PowerCoefficients k = power_coefficients(method, e);
      plot.series.push_back({label_of(method, e, 2), angles, mapped(angles, [&](double a) {
                               const double ratio = power(k, cosine_of(a)) / std::pow(cosine_of(a), e);
                               return within(100 * (ratio - 1), -limit, limit);
                             })});
    }
  }
  return plot;
}

Plot max_relative_error_figure(std::span<const PowerMethod> methods, double max_exponent, double level) {
  require_some(methods.size(), "method");
  Plot plot;
  plot.title = fmt::format("largest relative error where the lobe is at least {}", level);
  plot.x_label = "exponent e";
  plot.y_label = "largest relative error (%)";
  plot.log_x = true;
  plot.y_min = 0;
  for (PowerMethod method : methods) {
    std::vector<double> e;
    for (double x = power_info(method).min_exponent(); x <= max_exponent; x += x / 64) e.push_back(x);
    plot.series.push_back({std::string(power_info(method).name), e,
                           mapped(e, [&](double x) { return 100 * max_relative_error(method, x, level); })});
  }
  return plot;
}

Plot coefficient_figure() {
  Plot plot;
  plot.title = "a(e) is affine: e |a(e) − (2(1 − exp(−1/2)) e − 1/2)|";
  plot.x_label = "exponent e";
  plot.y_label = "e × difference";
  plot.log_x = true;
  plot.y_min = 0;
  std::vector<double> e;
  for (double x = 1; x <= 1000; x *= 1.01) e.push_back(x);
  plot.series.push_back({"difference × e", e, mapped(e, [](double x) {
                           return x * std::abs(quadratic_coefficient(x) - quadratic_coefficient_affine(x));
                         })});
  plot.series.push_back({"0.15", {2, 1000}, {0.15, 0.15}, PlotStyle::dashed});
  return plot;
}

Plot front_figure(double exponent) {
  Plot plot;
  plot.title = fmt::format("largest error and cost at e = {}", exponent);
  plot.x_label = "cost: multiplies + adds + compares + 5 (divisions + roots) + 20 transcendentals";
  plot.y_label = "largest absolute error";
  plot.log_x = plot.log_y = true;
  plot.x_min = 4;
  plot.x_max = 70;

  // members that no other beats in cost and error both, the others grey
  struct Member {
    std::string name;
    double cost, error;
  };
  std::vector<Member> members;
  for (const PowerInfo& info : power_methods())
    if (info.method != PowerMethod::exact && info.method != PowerMethod::quadratic_raw &&
        exponent >= info.min_exponent())
      members.push_back({std::string(info.name), static_cast<double>(info.cost.weight()),
                         max_absolute_error(info.method, exponent)});
  const auto beaten = [&](const Member& p) {
    return std::any_of(members.begin(), members.end(), [&](const Member& q) {
      return q.cost <= p.cost && q.error <= p.error && (q.cost < p.cost || q.error < p.error);
    });
  };
  PlotSeries others{"beaten in both", {}, {}, PlotStyle::points, "#9a9a9a"};
  for (const Member& p : members) {
    if (!beaten(p)) {
      plot.series.push_back({p.name, {p.cost}, {p.error}, PlotStyle::points});
    } else {
      others.x.push_back(p.cost);
      others.y.push_back(p.error);
    }
  }
  plot.series.push_back(others);
  return plot;
}

SphereFigure sphere_figure(std::span<const PowerMethod> methods, double exponent, int size) {
  require_some(methods.size(), "method");
  if (size < 32 || size > 1024) throw Error(fmt::format("tile width: expected 32 to 1024, found {}", size));
  const Vec3 wo{0, 0, 1}, wi = spherical_direction(radians(30), 0), h = half_vector(wi, wo);
  // The sphere's silhouette touches the tile; beside it the cosine is 0.
  const auto cosine_at = [&](double x, double y) {
    const double rr = x * x + y * y;
    return rr < 1 ? std::max(0.0, blinn_cosine(wi, wo, {x, y, std::sqrt(1 - rr)})) : 0.0;
  };
  constexpr int kGap = 4;
  const int step = size + kGap;
  // half the width of the magnified part: a little more than where the power is 1/500.
  const double reach = std::min(1.0, 1.1 * std::sin(std::acos(std::pow(1.0 / 500, 1 / exponent))));
  SphereFigure figure{Image8(static_cast<int>(methods.size()) * step, 3 * step, 3), 0};
  std::fill(figure.image.pixels.begin(), figure.image.pixels.end(), std::uint8_t{255});

  // one tile: value(cosine) in [0, 1] as grey, over the whole sphere or round the highlight.
  const auto tile = [&](std::size_t column, int row, bool magnified, auto value) {
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        double x = 2 * (i + 0.5) / size - 1, y = 1 - 2 * (j + 0.5) / size;
        if (magnified) {
          x = h.x + reach * x;
          y = h.y + reach * y;
        }
        const double v = std::clamp(value(cosine_at(x, y)), 0.0, 1.0);
        const auto grey = static_cast<std::uint8_t>(std::lround(255 * v));
        for (auto& channel : figure.image.at(static_cast<int>(column) * step + i, row * step + j))
          channel = grey;
      }
  };

  // columns of members; rows: the lobe, its highlight magnified, what is wrong with it
  std::vector<PowerCoefficients> k;
  for (PowerMethod method : methods) {
    k.push_back(power_coefficients(method, exponent));
    figure.max_difference = std::max(figure.max_difference, max_absolute_error(method, exponent));
  }
  const double scale = figure.max_difference > 0 ? 0.5 / figure.max_difference : 0;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    tile(m, 0, false, [&](double c) { return power(k[m], c); });
    tile(m, 1, true, [&](double c) { return std::pow(std::max(power(k[m], c), 0.0), 1 / 2.2); });
    tile(m, 2, true, [&](double c) { return 0.5 + scale * (power(k[m], c) - std::pow(c, exponent)); });
  }
  return figure;
}

}  // namespace burnish
