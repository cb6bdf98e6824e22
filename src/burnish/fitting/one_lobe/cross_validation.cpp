// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <burnish/fitting/one_lobe/cross_validation.h>
#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// Returns the samples of a fold alone, or all others.
SampleSource part_of(const SampleSource& source, std::size_t folds, std::size_t fold, bool inside) {
  SampleSource part = source;
  part.fill = [&source, folds, fold, inside](std::size_t begin, std::span<DirectionPair> pairs,
                                             std::span<double> values, std::span<double> weights) {
    source.fill(begin, pairs, values, weights);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (((begin + i) % source.distinct % folds == fold) != inside) weights[i] = 0;
  };
  return part;
}

}  // namespace

double held_out_error(const SampleSource& source, const ModelSpec& spec, const HomomorphicOptions& options,
                      std::size_t folds) {
  HomomorphicOptions quiet = options;
  quiet.progress = nullptr;  // the folds are fitted side by side
  std::vector<ErrorSum> parts(folds);
  for_each_chunk(folds, 1, [&](std::size_t fold, std::size_t, std::size_t) {
    const FactoredBrdf model = fit_homomorphic(part_of(source, folds, fold, false), spec, quiet).brdf;
    parts[fold] = log_error(part_of(source, folds, fold, true), model, options.error_floor);
  });
  ErrorSum sum;
  for (const ErrorSum& part : parts) {
    sum.error += part.error;
    sum.weight += part.weight;
  }
  return sum.mean();
}

std::vector<SmoothTrial> choose_smoothness(const SampleSource& source, const ModelSpec& spec,
                                           const HomomorphicOptions& options) {
  constexpr int kFirstDecade = -1, kLastDecade = -10, kWorseDecades = 2;
  const bool many = source.distinct > kManySamples;
  // A fold without samples would be one more fit to all of them.
  const std::size_t folds = many ? 2 : std::clamp<std::size_t>(source.distinct, 2, 5),
                    tables = spec.tables.size();
  const int rounds = many || tables == 1 ? 0 : 2;
  const double expected = kFirstDecade - kLastDecade + 3 + 2.5 * rounds * static_cast<double>(tables);
  HomomorphicOptions trial_options = options;
  trial_options.progress = nullptr;
  if (many) trial_options.reweightings = 0;
  ModelSpec trial_spec = spec;

  std::vector<SmoothTrial> trials;
  const auto attempt = [&](double smooth, const std::vector<double>& shares) {
    trial_options.smooth = smooth;
    for (std::size_t t = 0; t < tables; ++t) trial_spec.tables[t].smooth_share = shares[t];
    trials.push_back({smooth, shares, held_out_error(source, trial_spec, trial_options, folds)});
    if (options.progress) options.progress(std::min(1.0, static_cast<double>(trials.size()) / expected));
    return trials.back();
  };
  SmoothTrial best{.error = std::numeric_limits<double>::infinity()};
  const auto improves = [&](const SmoothTrial& trial) {
    if (!(trial.error < best.error)) return false;
    best = trial;
    return true;
  };

  // The smoothness of all tables is tried by decades. It starts from the smooth side, since rough tables can be wild
  // at any of several decades.
  std::vector<double> shares;
  for (const ModelSpec::TableSpec& table : spec.tables) shares.push_back(table.smooth_share);
  best.shares = shares;
  int worse = 0;
  for (int decade = kFirstDecade; decade >= kLastDecade && worse < kWorseDecades; --decade)
    worse = improves(attempt(std::pow(10.0, decade), shares)) ? 0 : worse + 1;
  // Each table's share of it is moved by factors of ten while that helps.
  for (int round = 0; round < rounds; ++round)
    for (std::size_t t = 0; t < tables; ++t)
      for (const double before = best.shares[t]; const double factor : {0.1, 10.0}) {
        bool moved = false;
        do {
          shares = best.shares;
          shares[t] *= factor;
          moved = improves(attempt(best.smooth, shares));
        } while (moved && shares[t] > 1e-4 && shares[t] < 1e4);
        if (best.shares[t] != before) break;  // this way helped, the other would undo it
      }
  // Last, half a decade either way is tried.
  for (const double factor : {std::sqrt(0.1), std::sqrt(10.0)})
    improves(attempt(best.smooth * factor, best.shares));
  std::ranges::stable_sort(trials, {}, &SmoothTrial::error);
  return trials;
}

}  // namespace burnish
