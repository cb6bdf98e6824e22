// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <burnish/error.h>
#include <burnish/fitting/numerics/node_numbers.h>
#include <burnish/fitting/one_lobe/conjugate_gradients.h>
#include <burnish/fitting/one_lobe/homomorphic.h>
#include <burnish/fitting/one_lobe/log_error.h>
#include <burnish/fitting/one_lobe/normal_equations.h>

namespace burnish {

namespace {

// Up to here the normal equations fit the caches and their solution costs less than a pass over the samples.
constexpr std::size_t kMaxNormalEquations = 512;

// The diffuse reflection of white is 1 / pi: a floor above hides all but highlights.
constexpr double kMaxFloor = 1;

LogSolution solve(const RowMaker& rows, const HomomorphicOptions& options) {
  const auto channels = rows.source->channels;
  return coupled_unknowns(*rows.spec, channels) <= kMaxNormalEquations
             ? solve_normal_equations(rows, options)
             : solve_by_conjugate_gradients(rows, options);
}

// Returns the tables of a solution, still as logarithms, in the formats that they will be stored in.
std::vector<Table> to_tables(const LogSolution& solution, const Numbering& numbering, const ModelSpec& spec,
                             TableFormat format) {
  std::vector<Table> tables;
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    const auto [base, copies] = numbering.tables[t];
    const auto* first = solution.log_values.data() + base;
    tables.push_back({.name = spec.tables[t].name,
                      .layout = spec.tables[t].layout,
                      .channels = copies,
                      .values = {first, first + spec.tables[t].layout.node_count() * copies},
                      .format = format_of(spec.tables[t], format)});
  }
  return tables;
}

Lobe to_lobe(const LogSolution& solution, const ModelSpec& spec) {
  return {.scale = solution.channel_offset, .factors = spec.lobes.front()};
}

void check_formats(const ModelSpec& spec, std::size_t channels, TableFormat format) {
  for (const ModelSpec::TableSpec& t : spec.tables)
    check_format(
        {.name = t.name, .channels = t.shared ? 1 : channels, .values = {}, .format = format_of(t, format)});
}

}  // namespace

HomomorphicFit fit_homomorphic(const SampleSource& source, const ModelSpec& spec,
                               const HomomorphicOptions& options) {
  if (spec.lobes.size() != 1 || spec.lobes.front().empty())
    throw Error("fit: expected a model of one lobe for a log-linear fit, found another");
  if (source.count == 0) throw Error("fit: expected samples, found none");
  const auto is_floor = [](double floor) { return floor > 0 && floor <= kMaxFloor; };
  if (!(options.smooth >= 0) || !std::isfinite(options.smooth) || !is_floor(options.floor) ||
      !is_floor(options.error_floor) || options.reweightings < 0 || !(options.backscatter >= 0))
    throw Error("fit: expected smooth >= 0, floors > 0 and at most 1, reweightings and backscatter >= 0");

  check_formats(spec, source.channels, options.format);

  // The first pass is least squares in log f.
  RowMaker rows(source, spec, options.floor, options.error_floor);
  rows.backscatter = options.backscatter;
  const Numbering numbering = number_nodes(spec, source.channels);
  LogSolution solution = solve(rows, options);
  FitSummary summary = solution.summary;
  int reweightings = 0;

  // Further passes reweight towards the least absolute error; the best pass is kept.
  if (options.reweightings > 0) {
    const auto unrounded = [&](const LogSolution& s) {
      return from_log_tables(source.channels, to_tables(s, numbering, spec, options.format),
                             {to_lobe(s, spec)}, TableFormat::single);
    };
    FactoredBrdf current = unrounded(solution);
    double smallest = log_error(source, current, options.error_floor).mean();
    for (int pass = 0; pass < options.reweightings; ++pass) {
      rows.current = &current;
      LogSolution next = solve(rows, options);
      summary.iterations += next.summary.iterations;
      current = unrounded(next);
      const double error = log_error(source, current, options.error_floor).mean();
      if (error < smallest) {
        smallest = error;
        solution = std::move(next);
        reweightings = pass + 1;
      }
    }
  }
  return {.brdf = from_log_tables(source.channels, to_tables(solution, numbering, spec, options.format),
                                  {to_lobe(solution, spec)}),
          .summary = summary,
          .samples = solution.samples,
          .unknowns = numbering.count,
          .reweightings = reweightings};
}

}  // namespace burnish
