// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/baselines/separable_brdf.h>
#include <burnish/error.h>
#include <burnish/fitting/baselines/analytic_fit.h>
#include <burnish/fitting/baselines/gathered_samples.h>
#include <burnish/fitting/numerics/bounded_least_squares.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, 5> kFittable = {"cook_torrance", "ggx", "ward", "ashikhmin_shirley",
                                                       "lafortune"};

constexpr std::array kRoughnesses = {0.03, 0.1, 0.25, 0.5};
constexpr std::array kExponents = {4.0, 20.0, 100.0, 700.0};

/// An unknown: a parameter, or one channel of a colour, or two parameters that are equal.
struct Unknown {
  std::size_t parameter;
  std::optional<std::size_t> equal;  ///< another parameter with the same value
  int channel = -1;                  ///< of a colour; -1: all
  bool logarithmic = false;          ///< what is varied is the logarithm
  double lower, upper;               ///< of what is varied
  int part = 0;                      ///< of the model, see part_of
};

bool is_scale_free(std::string_view name) {
  return name.starts_with("alpha") || name.starts_with("exponent");
}

/// A sum's parts vary apart: the diffuse term of lafortune, 0, and its lobes, 1 to 3, which the last
/// characters of parameters' names number. Other models are one part.
constexpr int kLobes = 3;

int part_of(const AnalyticModel& model, std::string_view parameter) {
  if (model.name != "lafortune" || parameter == "kd") return 0;
  return parameter.ends_with('2') ? 2 : parameter.ends_with('3') ? 3 : 1;
}

/// Which parameters vary together and how, for a model.
class Parameters {
 public:
  Parameters(const AnalyticModel& model, bool isotropic, std::size_t channels) : model_(&model) {
    for (std::size_t p = 0; p < model.parameters.size(); ++p) {
      const AnalyticParameter& parameter = model.parameters[p];
      if (isotropic && twin_of_previous(p)) {
        unknowns_.back().equal = p;
        continue;
      }
      const bool logarithmic = is_scale_free(parameter.name);
      // a power of 0 has no logarithm
      const double least = logarithmic ? std::max(parameter.min, 1e-3) : parameter.min;
      Unknown unknown{.parameter = p,
                      .equal = {},
                      .logarithmic = logarithmic,
                      .lower = logarithmic ? std::log(least) : least,
                      .upper = logarithmic ? std::log(parameter.max) : parameter.max,
                      .part = part_of(model, parameter.name)};
      for (int c = 0; c < (parameter.color && channels == 3 ? 3 : 1); ++c) {
        unknown.channel = parameter.color && channels == 3 ? c : -1;
        unknowns_.push_back(unknown);
      }
    }
  }

  const AnalyticModel& model() const { return *model_; }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  int parts() const { return unknowns_.back().part + 1; }

  /// The model's values, all of it or one part alone, the colours of the others being black.
  std::vector<Rgb> values(std::span<const double> x, std::optional<int> part = {}) const {
    std::vector<Rgb> result(model_->parameters.size());
    for (std::size_t k = 0; k < unknowns_.size(); ++k) {
      const Unknown& u = unknowns_[k];
      const double value = u.logarithmic ? std::exp(x[k]) : x[k];
      if (u.channel < 0)
        result[u.parameter] = value;
      else
        (u.channel == 0   ? result[u.parameter].r
         : u.channel == 1 ? result[u.parameter].g
                          : result[u.parameter].b) = value;
      if (u.equal) result[*u.equal] = value;
      if (part && u.part != *part && model_->parameters[u.parameter].color) result[u.parameter] = {};
    }
    return result;
  }

  /// Sets what is varied for a parameter, all channels.
  void set(std::string_view name, double value, std::vector<double>& x) const {
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      if (model_->parameters[unknowns_[k].parameter].name == name)
        x[k] = std::clamp(unknowns_[k].logarithmic ? std::log(value) : value, unknowns_[k].lower,
                          unknowns_[k].upper);
  }

 private:
  // alpha_y after alpha_x, exponent_y after exponent_x, cy after cx
  bool twin_of_previous(std::size_t p) const {
    if (p == 0) return false;
    const std::string_view name = model_->parameters[p].name, before = model_->parameters[p - 1].name;
    const std::size_t at = name.find('y');
    return at != std::string_view::npos && name.size() == before.size() && before[at] == 'x' &&
           name.substr(0, at) == before.substr(0, at) && name.substr(at + 1) == before.substr(at + 1);
  }

  const AnalyticModel* model_;
  std::vector<Unknown> unknowns_;
};

// cbrt(f r)^2 below which the slope of the cube root rises no further.
constexpr double kMinSquare = 1e-8;

/// Residuals sqrt(weight) (cbrt(f^ r) - cbrt(f r)), r the root of the cosines, a sample and channel each, as
/// functions of some of the unknowns.
class Cost {
 public:
  Cost(const GatheredSamples& samples, const Parameters& parameters)
      : samples_(samples), parameters_(parameters) {
    double total = 0;
    for (const double w : samples.weights) total += w;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double root = separable_divisor(samples.pairs[i].wi, samples.pairs[i].wo);
      const double weight = std::sqrt(samples.weights[i] / (total * static_cast<double>(samples.channels)));
      roots_.push_back(root);
      weights_.push_back(weight);
      for (std::size_t c = 0; c < samples.channels; ++c)
        targets_.push_back(std::cbrt(samples.values[i * samples.channels + c] * root));
    }
  }

  /// Holds all unknowns at x but those whose numbers are `varied`, rising, the channels of a colour together.
  void hold(std::vector<double> x, std::vector<std::size_t> varied) {
    held_ = std::move(x);
    varied_ = std::move(varied);
  }

  std::size_t residuals() const { return targets_.size(); }

  /// All unknowns.
  std::vector<double> all(std::span<const double> varied) const {
    std::vector<double> x = held_;
    for (std::size_t k = 0; k < varied_.size(); ++k) x[varied_[k]] = varied[k];
    return x;
  }

  /// Evaluates as LeastSquaresProblem::evaluate says.
  void evaluate(std::span<const double> varied, std::span<double> residuals, std::span<double> jacobian) {
    std::vector<double> x = all(varied);
    if (x != evaluated_at_) {  // slopes are asked for where values were
      parts_.resize(static_cast<std::size_t>(parameters_.parts()));
      for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p] = evaluate_part(x, static_cast<int>(p));
      evaluated_at_ = std::move(x);
    }
    for (std::size_t r = 0; r < targets_.size(); ++r) {
      double value = 0;
      for (const std::vector<double>& part : parts_) value += part[r];
      residuals[r] = weights_[r / samples_.channels] * (std::cbrt(value) - targets_[r]);
    }
    if (!jacobian.empty()) differentiate(residuals, jacobian);
  }

 private:
  // f r of every sample and channel, of one part.
  std::vector<double> evaluate_part(std::span<const double> x, int part) const {
    const AnalyticVariant variant = parameters_.model().build(parameters_.values(x, part));
    const BrdfRef brdf = std::visit([](const auto& any) -> BrdfRef { return any; }, variant);
    const std::size_t channels = samples_.channels;
    std::vector<double> values(targets_.size());
    constexpr std::size_t kChunk = 1024;
    for_each_chunk(samples_.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::vector<double> f(3 * (end - begin));
      std::vector<std::uint8_t> known(end - begin);
      brdf.eval(std::span(samples_.pairs).subspan(begin, end - begin), f, known);
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < channels; ++c)
          values[i * channels + c] = f[3 * (i - begin) + c] * roots_[i];
    });
    return values;
  }

  // Forward differences of f; the channels of a colour, which do not see each other, in one evaluation.
  void differentiate(std::span<const double> residuals, std::span<double> jacobian) const {
    const std::vector<Unknown>& unknowns = parameters_.unknowns();
    const std::size_t columns = varied_.size(), rows = targets_.size();
    std::vector<double> slopes(rows);  // of residuals by f r
    for (std::size_t r = 0; r < rows; ++r) {
      const double weight = weights_[r / samples_.channels], root = residuals[r] / weight + targets_[r];
      slopes[r] = weight / (3 * std::max(root * root, kMinSquare));
    }
    for (std::size_t k = 0; k < columns;) {
      const Unknown& first = unknowns[varied_[k]];
      const std::size_t group = first.channel < 0 ? 1 : 3;
      std::vector<double> moved = evaluated_at_;
      std::array<double, 3> step{};
      for (std::size_t g = 0; g < group; ++g) {
        // inwards where a bound is near
        double& at = moved[varied_[k + g]];
        const double size = 1e-6 * std::max(std::abs(at), 0.01);
        step[g] = at + size > first.upper ? -size : size;
        at += step[g];
      }
      const std::vector<double>& values = parts_[static_cast<std::size_t>(first.part)];
      const std::vector<double> moved_values = evaluate_part(moved, first.part);
      for (double& size : step) size = 1 / size;
      for (std::size_t r = 0; r < rows; ++r) {
        const double slope = slopes[r] * (moved_values[r] - values[r]);
        for (std::size_t g = 0; g < group; ++g)
          jacobian[r * columns + k + g] = group == 3 && r % 3 != g ? 0 : slope * step[g];
      }
      k += group;
    }
  }

  const GatheredSamples& samples_;
  const Parameters& parameters_;
  std::vector<double> roots_, weights_, targets_, held_;
  std::vector<std::size_t> varied_;
  std::vector<double> evaluated_at_;
  std::vector<std::vector<double>> parts_;
};

/// Minimizations from several starts of which the best is kept.
class Fit {
 public:
  Fit(const GatheredSamples& samples, const Parameters& parameters, const AnalyticFitOptions& options)
      : parameters_(parameters), options_(options), cost_(samples, parameters) {}

  /// One minimization from x over the unknowns of the first `parts` parts; the others keep their values.
  void run(std::vector<double> x, int parts) {
    // what varies, within its bounds
    const std::vector<Unknown>& unknowns = parameters_.unknowns();
    LeastSquaresProblem problem{.functions = cost_.residuals(), .evaluate = {}, .lower = {}, .upper = {}};
    std::vector<std::size_t> varied;
    std::vector<double> start;
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      if (unknowns[k].part >= parts) continue;
      varied.push_back(k);
      start.push_back(x[k]);
      problem.lower.push_back(unknowns[k].lower);
      problem.upper.push_back(unknowns[k].upper);
    }
    cost_.hold(std::move(x), varied);
    problem.evaluate = [this](auto at, auto values, auto slopes) { cost_.evaluate(at, values, slopes); };
    const LeastSquaresSolution solution =
        solve_least_squares(problem, std::move(start), {.max_iterations = options_.max_iterations});
    ++starts;
    iterations += solution.iterations;
    if (solution.cost >= best_cost) return;
    best_cost = solution.cost;
    first_cost = solution.first_cost;
    converged = solution.converged;
    best = cost_.all(solution.x);
  }

  std::vector<double> best;
  double best_cost = std::numeric_limits<double>::infinity(), first_cost = 0;
  int starts = 0, iterations = 0;
  bool converged = false;

 private:
  const Parameters& parameters_;
  const AnalyticFitOptions& options_;
  Cost cost_;
};

// kd of a Lambertian surface as bright as the darker values are.
double diffuse_guess(const GatheredSamples& samples) {
  std::vector<double> values = samples.values;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 3);
  std::nth_element(values.begin(), middle, values.end());
  return std::clamp(kPi * *middle, 0.005, 0.9);
}

constexpr std::string_view suffix(int lobe) {
  return lobe == 0 ? "" : lobe == 1 ? "2" : "3";
}

void fit_lafortune(const Parameters& parameters, double kd, const std::function<void(double)>& progress,
                   Fit& fit) {
  std::vector<double> x(parameters.unknowns().size());
  parameters.set("kd", kd, x);
  for (int lobe = 0; lobe < kLobes; ++lobe) {
    const auto set = [&](std::string_view name, double value) {
      parameters.set(fmt::format("{}{}", name, suffix(lobe)), value, x);
    };
    if (lobe == 0)
      for (int other = 0; other < kLobes; ++other)
        for (const auto& [name, value] :
             {std::pair{"cx", -0.9}, {"cy", -0.9}, {"cz", 0.9}, {"exponent", 20.0}})
          parameters.set(fmt::format("{}{}", name, suffix(other)), value, x);
    else
      x = fit.best;
    set("ks", 0.1);
    for (std::size_t i = 0; i < kExponents.size(); ++i) {
      set("exponent", kExponents[i]);
      fit.run(x, lobe + 2);  // the diffuse term and the lobes up to this one; those to come stay black
      if (progress)
        progress((lobe + static_cast<double>(i + 1) / static_cast<double>(kExponents.size())) / kLobes);
    }
  }
}

void fit_roughness(const Parameters& parameters, double kd, const std::function<void(double)>& progress,
                   Fit& fit) {
  std::vector<double> x(parameters.unknowns().size());
  parameters.set("kd", kd, x);
  parameters.set("f0", 0.1, x);
  parameters.set("ks", 0.1, x);
  for (std::size_t i = 0; i < kRoughnesses.size(); ++i) {
    const double alpha = kRoughnesses[i];
    for (const std::string_view name : {"alpha", "alpha_x", "alpha_y"}) parameters.set(name, alpha, x);
    // a Gaussian of slopes of roughness alpha is about a power of 2 / alpha^2
    for (const std::string_view name : {"exponent_x", "exponent_y"})
      parameters.set(name, 2 / (alpha * alpha), x);
    fit.run(x, parameters.parts());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(kRoughnesses.size()));
  }
}

}  // namespace

std::span<const std::string_view> fittable_models() {
  return kFittable;
}

AnalyticFit fit_analytic(const SampleSource& source, std::string_view name,
                         const AnalyticFitOptions& options) {
  if (std::find(kFittable.begin(), kFittable.end(), name) == kFittable.end())
    throw Error(
        fmt::format("analytic fit: expected one of {}, found '{}'", fmt::join(kFittable, ", "), name));
  if (source.channels != 1 && source.channels != 3)
    throw Error(fmt::format("analytic fit: expected 1 or 3 channels, found {}", source.channels));
  const AnalyticBrdf defaults = parse_analytic(name);
  const AnalyticModel& model = defaults.model();
  const GatheredSamples samples = gather_samples(source, options.most_samples);
  const Parameters parameters(model, source.isotropic, source.channels);
  Fit fit(samples, parameters, options);
  (name == "lafortune" ? fit_lafortune : fit_roughness)(parameters, diffuse_guess(samples), options.progress,
                                                        fit);

  std::vector<Rgb> values = parameters.values(fit.best);
  for (std::size_t p = 0; p < values.size(); ++p) {
    const AnalyticParameter& parameter = model.parameters[p];
    const auto rounded = [&](double x) {
      return std::clamp(static_cast<double>(static_cast<float>(x)), parameter.min, parameter.max);
    };
    values[p] = {rounded(values[p].r), rounded(values[p].g), rounded(values[p].b)};
  }
  // the cost is half the sum of squares
  return {.brdf = AnalyticBrdf(model, std::move(values)),
          .summary = {.error_before = std::sqrt(2 * fit.first_cost),
                      .error_after = std::sqrt(2 * fit.best_cost),
                      .iterations = fit.iterations,
                      .stop_reason = fit.converged ? StopReason::converged : StopReason::iteration_limit},
          .starts = fit.starts};
}

}  // namespace burnish
