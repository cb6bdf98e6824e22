// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <burnish/capture/texels/normal_steps.h>
#include <burnish/capture/texels/texel_block.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/math/parallel.h>

namespace burnish {

TexelSolver::TexelSolver(const FactoredBrdf& lobes, const CaptureForm& form, double exposure)
    : evaluator_(lobes), form_(form), exposure_(exposure) {}

namespace {

// The texels that one thread takes at a time. Its blocks share one allocation.
constexpr std::size_t kChunk = 8 * kTexelLanes;

/// Adds the squared errors of one picture of a block, as they are seen.
void add_errors(const TexelBlock& block, std::size_t k, const TexelSamples& samples, float exposure,
                TexelSolver::PictureError& error) {
  const std::size_t count = block.range().count;
  std::array<TexelRow, kCaptureChannels> seen, shown;
  for (std::size_t c = 0; c < kCaptureChannels; ++c) {
    // The camera would have clipped the model at the same value.
    const TexelRow& measured = block.measured(k, c);
    TexelRow model = block.modelled(k, c);
    for (std::size_t i = 0; i < count; ++i)
      if (is_clipped(samples.states[block.pixel(k, i)], c)) model[i] = std::min(model[i], measured[i]);
    find_seen(exposure, measured.data(), seen[c].data());
    find_seen(exposure, model.data(), shown[c].data());
  }
  for (std::size_t i = 0; i < count; ++i) {
    const PixelState state = samples.states[block.pixel(k, i)];
    if (state == PixelState::missing) continue;
    // The squares of a pixel's channels are rounded to units once, so that sums do not depend on their order.
    double square = 0;
    for (std::size_t c = 0; c < kCaptureChannels; ++c) {
      const double off = static_cast<double>(seen[c][i]) - static_cast<double>(shown[c][i]);
      square += off * off;
    }
    const auto units = static_cast<std::uint64_t>(std::llround(square / TexelSolver::PictureError::kUnit));
    error.all += units;
    error.all_count += kCaptureChannels;
    if (state == PixelState::masked) continue;
    error.seen += units;
    error.seen_count += kCaptureChannels;
  }
}

/// Keeps the results of a block's texels.
void keep(TexelBlock& block, const TexelSolver::Options& options, TexelFits& fits) {
  const auto [first, count] = block.range();
  const std::size_t lobes = block.lobes();
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < lobes; ++j) fits.weights[(first + i) * lobes + j] = block.weights()[j][i];
  if (options.costs)
    std::ranges::copy_n(block.costs().begin(), static_cast<std::ptrdiff_t>(count), &fits.costs[first]);
  if (!options.trust) return;
  // Pixels are trusted by the errors that the last weights leave.
  block.find_equations(TexelBlock::kLastPass);
  for (std::size_t k = 0; k < block.pictures().size(); ++k)
    for (std::size_t i = 0; i < count; ++i) fits.trust[block.pixel(k, i)] = block.trust(k, i);
}

}  // namespace

TexelFits TexelSolver::solve(const TexelSamples& samples, std::vector<float> normals,
                             const Options& options) const {
  TexelFits fits{.weights = std::vector<float>(samples.size() * lobes()),
                 .normals = std::move(normals),
                 .trust = {},
                 .costs = {}};
  if (options.normals && fits.normals.empty()) fits.normals.resize(2 * samples.size());
  if (options.trust) fits.trust.resize(samples.states.size());
  if (options.costs) fits.costs.resize(samples.size());
  float* const xy = fits.normals.empty() ? nullptr : fits.normals.data();
  const TexelSetting setting{
      .lobes = evaluator_, .form = form_, .samples = samples, .exposure = static_cast<float>(exposure_)};
  for_each_chunk(samples.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto block = std::make_unique<TexelBlock>(setting, false);
    NormalSteps steps(*block);
    for (std::size_t first = begin; first < end; first += kTexelLanes) {
      block->begin({.first = first, .count = std::min(kTexelLanes, end - first)}, xy);
      // Normals start from the weights of a first pass, and the other passes use these normals.
      block->fit_weights(options.normals ? 1 : options.passes, 0);
      if (options.normals) {
        steps.run(xy, options.normal_steps);
        block->fit_weights(options.passes, 1);
      }
      keep(*block, options, fits);
    }
  });
  return fits;
}

std::vector<TexelSolver::PictureError> TexelSolver::errors(const TexelSamples& samples,
                                                           const TexelFits& fits) const {
  const float* const xy = fits.normals.empty() ? nullptr : fits.normals.data();
  std::vector<std::vector<PictureError>> partial(chunk_count(samples.size(), kChunk));
  const auto exposure = static_cast<float>(exposure_);
  const TexelSetting setting{.lobes = evaluator_, .form = form_, .samples = samples, .exposure = exposure};
  for_each_chunk(samples.size(), kChunk, [&](std::size_t number, std::size_t begin, std::size_t end) {
    std::vector<PictureError>& errors = partial[number];
    errors.resize(samples.pictures);
    for (const bool held_out : {false, true}) {
      const auto block = std::make_unique<TexelBlock>(setting, held_out);
      for (std::size_t first = begin; first < end; first += kTexelLanes) {
        block->begin({.first = first, .count = std::min(kTexelLanes, end - first)}, xy);
        block->load_weights(fits.weights.data());
        for (std::size_t k = 0; k < block->pictures().size(); ++k)
          add_errors(*block, k, samples, exposure, errors[block->pictures()[k]]);
      }
    }
  });
  std::vector<PictureError> sums(samples.pictures);
  for (const auto& part : partial)
    for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += part[p];
  return sums;
}

}  // namespace burnish
