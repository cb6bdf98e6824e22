#include <utility>

#include <burnish/error.h>
#include <burnish/fitting/homomorphic.h>
#include <burnish/fitting/log_rows.h>

namespace burnish {

namespace {

// Up to here the normal equations fit the caches and their solution costs less than a pass over the samples.
constexpr std::size_t kMostDirectUnknowns = 1024;

bool solved_directly(const ModelSpec& spec, std::size_t unknowns, int channels) {
  bool shared = false;
  for (const ModelSpec::TableSpec& table : spec.tables) shared = shared || table.shared;
  const bool coupled = shared && channels > 1;
  return (coupled ? unknowns : unknowns / static_cast<std::size_t>(channels)) <= kMostDirectUnknowns;
}

}  // namespace

HomomorphicFit fit_homomorphic(const SampleSource& source, const ModelSpec& spec,
                               const HomomorphicOptions& options) {
  if (spec.lobes.size() != 1 || spec.lobes.front().empty())
    throw Error("fit: a log-linear fit takes a model of one lobe");
  if (source.count == 0) throw Error("fit: expected samples, found none");
  if (!(options.smooth >= 0) || !(options.floor > 0))
    throw Error("fit: expected smooth >= 0 and floor > 0, found others");
  const RowMaker rows{.source = &source, .spec = &spec, .floor = options.floor};

  const Unknowns unknowns = number_unknowns(spec, source.channels);
  LogSolution solution = solved_directly(spec, unknowns.count, source.channels)
                             ? solve_directly(rows, unknowns, options)
                             : solve_iteratively(rows, unknowns, options);

  std::vector<Table> tables;
  for (std::size_t t = 0; t < spec.tables.size(); ++t) {
    const auto* first = solution.log_values.data() + unknowns.base[t];
    tables.push_back({.name = spec.tables[t].name,
                      .layout = spec.tables[t].layout,
                      .channels = static_cast<int>(unknowns.channels[t]),
                      .values = {first, first + spec.tables[t].layout.node_count() * unknowns.channels[t]}});
  }
  Lobe lobe{.scale = std::move(solution.channel_offset), .factors = spec.lobes.front()};
  return {.brdf = from_log_tables(source.channels, std::move(tables), {std::move(lobe)}, options.format),
          .summary = {.samples = solution.samples,
                      .unknowns = unknowns.count,
                      .error_before = solution.error_before,
                      .error_after = solution.error_after,
                      .iterations = solution.iterations,
                      .stop_reason = std::move(solution.stop_reason),
                      .smooth = options.smooth}};
}

}  // namespace burnish
