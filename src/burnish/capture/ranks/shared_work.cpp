// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>

#include <burnish/capture/ranks/shared_work.h>

namespace burnish {

namespace {

TexelSamples part_of(const TexelSamples& all, std::size_t begin, std::size_t end) {
  TexelSamples part{.texels = {all.texels.begin() + static_cast<std::ptrdiff_t>(begin),
                               all.texels.begin() + static_cast<std::ptrdiff_t>(end)},
                    .pictures = all.pictures,
                    .values = {},
                    .states = {}};
  for (std::size_t p = 0; p < all.pictures; ++p) {
    const std::size_t first = p * all.size() + begin, count = end - begin;
    const auto values = std::span(all.values).subspan(3 * first, 3 * count);
    const auto states = std::span(all.states).subspan(first, count);
    part.values.insert(part.values.end(), values.begin(), values.end());
    part.states.insert(part.states.end(), states.begin(), states.end());
    if (all.directions.empty()) continue;
    const auto directions = std::span(all.directions).subspan(6 * first, 6 * count);
    part.directions.insert(part.directions.end(), directions.begin(), directions.end());
  }
  return part;
}

}  // namespace

std::vector<std::string> made_together(FitCrew* crew, std::size_t count,
                                       const std::function<std::string(std::size_t)>& make) {
  const std::size_t ranks = crew ? static_cast<std::size_t>(crew->ranks()) : 1,
                    rank = crew ? static_cast<std::size_t>(crew->rank()) : 0;
  std::vector<std::string> all(count);
  if (ranks == 1) {
    for (std::size_t i = 0; i < count; ++i) all[i] = make(i);
    return all;
  }
  // A rank's results follow each other, each after its size.
  std::string own;
  for (std::size_t i = rank; i < count; i += ranks) {
    const std::string made = make(i);
    const std::uint64_t size = made.size();
    append_values(own, std::span(&size, 1));
    own += made;
  }
  std::string joined;
  const std::vector<std::string> gathered = crew->gather(own);
  for (const std::string& part : gathered) joined += part;
  const std::string sent = crew->broadcast(joined);
  std::string_view rest = sent;
  for (std::size_t r = 0; r < ranks; ++r)
    for (std::size_t i = r; i < count; i += ranks) {
      std::uint64_t size = 0;
      take_values(rest, std::span(&size, 1));
      all[i] = rest.substr(0, size);
      rest.remove_prefix(size);
    }
  return all;
}

TexelFits solve_together(FitCrew* crew, const TexelSolver& solver, const TexelSamples& samples,
                         std::vector<float> normals, const TexelSolver::Options& options) {
  const std::size_t parts = crew ? static_cast<std::size_t>(crew->ranks()) : 1, texels = samples.size();
  if (parts == 1) return solver.solve(samples, std::move(normals), options);
  const auto begin_of = [&](std::size_t part) { return texels * part / parts; };
  const bool known = !normals.empty();
  const auto made = made_together(crew, parts, [&](std::size_t i) {
    const std::size_t begin = begin_of(i), end = begin_of(i + 1);
    std::vector<float> own;
    if (known)
      own.assign(normals.begin() + static_cast<std::ptrdiff_t>(2 * begin),
                 normals.begin() + static_cast<std::ptrdiff_t>(2 * end));
    const TexelFits fits = solver.solve(part_of(samples, begin, end), std::move(own), options);
    std::string bytes;
    append_values<float>(bytes, fits.weights);
    append_values<float>(bytes, fits.normals);
    append_values<float>(bytes, fits.trust);
    append_values<double>(bytes, fits.costs);
    return bytes;
  });

  TexelFits fits{.weights = std::vector<float>(texels * solver.lobes()),
                 .normals = std::vector<float>(known || options.normals ? 2 * texels : 0),
                 .trust = std::vector<float>(options.trust ? samples.states.size() : 0),
                 .costs = std::vector<double>(options.costs ? texels : 0)};
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t begin = begin_of(i), count = begin_of(i + 1) - begin;
    std::string_view rest = made[i];
    take_values(rest, std::span(fits.weights).subspan(begin * solver.lobes(), count * solver.lobes()));
    if (!fits.normals.empty()) take_values(rest, std::span(fits.normals).subspan(2 * begin, 2 * count));
    for (std::size_t p = 0; p < samples.pictures && options.trust; ++p)
      take_values(rest, std::span(fits.trust).subspan(p * texels + begin, count));
    if (options.costs) take_values(rest, std::span(fits.costs).subspan(begin, count));
  }
  return fits;
}

}  // namespace burnish
