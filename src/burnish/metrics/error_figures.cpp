// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/goniometer.h>

namespace burnish {
namespace {

constexpr std::size_t kChunk = 1024;  // pairs evaluated at a time

SpherePictures render(BrdfRef brdf, int size) {
  SpherePictures pictures;
  for (std::size_t i = 0; i < kSphereLights.size(); ++i)
    pictures.spheres[i] = render_sphere(brdf, kSphereLights[i], size);
  return pictures;
}

}  // namespace

Scorer::Scorer(BrdfRef reference, const FigureOptions& options) : reference_(reference), options_(options) {
  if (options.count == 0) throw Error("expected at least one direction pair, found 0");
  if (!(options.floor >= 0)) throw Error(fmt::format("expected a floor >= 0, found {}", options.floor));
  pictures_ = render(reference, options.image_size);
  exposure_ = sphere_exposure(pictures_.spheres);
  tone_map_known(pictures_);
  evaluated_ = evaluate(reference, draw_pairs(options.count, options.seed, reference.isotropic()));
}

Scorer::Evaluated Scorer::evaluate(BrdfRef brdf, std::vector<DirectionPair> pairs) {
  const auto channels = brdf.channels();
  Evaluated result{std::move(pairs), {}, {}};
  result.values.resize(result.pairs.size() * channels);
  result.known.resize(result.pairs.size());
  for_each_chunk(result.pairs.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    brdf.eval(std::span(result.pairs).subspan(begin, end - begin),
              std::span(result.values).subspan(begin * channels, (end - begin) * channels),
              std::span(result.known).subspan(begin, end - begin));
  });
  return result;
}

std::vector<PairError> Scorer::pair_errors(BrdfRef model) const {
  if (reference_.channels() != model.channels() && reference_.channels() != 1 && model.channels() != 1)
    throw Error(fmt::format("cannot compare a reference of {} channels with a model of {}",
                            reference_.channels(), model.channels()));
  // an anisotropic model may err in phi_h where the reference needs only one
  const bool turned = reference_.isotropic() && !model.isotropic();
  const Evaluated own =
      turned ? evaluate(reference_, draw_pairs(options_.count, options_.seed, false)) : Evaluated{};
  const Evaluated& truth = turned ? own : evaluated_;
  const Evaluated guess = evaluate(model, truth.pairs);

  // errors of all pairs, on all threads
  const auto reference_channels = reference_.channels();
  const auto model_channels = model.channels();
  std::vector<PairError> errors(truth.pairs.size());
  std::vector<std::uint8_t> known(truth.pairs.size());
  for_each_chunk(errors.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      known[i] = truth.known[i] && guess.known[i];
      if (known[i])
        errors[i] = pair_error(
            truth.pairs[i], std::span(truth.values).subspan(i * reference_channels, reference_channels),
            std::span(guess.values).subspan(i * model_channels, model_channels), options_.floor);
    }
  });

  // those that both know
  std::size_t kept = 0;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (known[i]) errors[kept++] = errors[i];
  errors.resize(kept);
  return errors;
}

void Scorer::tone_map_known(SpherePictures& pictures) const {
  for (std::size_t i = 0; i < pictures.spheres.size(); ++i) {
    pictures.shown[i] = tone_map(pictures.spheres[i].image, exposure_);
    const auto& known = pictures_.spheres[i].known;
    for (std::size_t p = 0; p < known.size(); ++p)
      if (!known[p]) {
        const int width = pictures.shown[i].width;
        std::ranges::fill(pictures.shown[i].at(static_cast<int>(p) % width, static_cast<int>(p) / width),
                          0.0f);
      }
  }
}

SpherePictures Scorer::pictures(BrdfRef model) const {
  SpherePictures pictures = render(model, options_.image_size);
  tone_map_known(pictures);
  return pictures;
}

double Scorer::picture_psnr(const SpherePictures& pictures) const {
  double squared = 0;
  for (std::size_t i = 0; i < pictures.shown.size(); ++i)
    squared += mean_squared_error(pictures_.shown[i], pictures.shown[i]);
  return psnr(squared / static_cast<double>(pictures.shown.size()));
}

ErrorFigures Scorer::score(BrdfRef model) const {
  const std::vector<PairError> errors = pair_errors(model);
  if (errors.empty()) throw Error("reference and model share no known direction pair");

  // means over the pairs
  ErrorFigures figures;
  double log_ratio = 0, log_ratio_sq = 0, difference_sq = 0, abs_log = 0, positive = 0;
  for (const PairError& error : errors) {
    figures.log_cos += error.log_cos;
    log_ratio += error.log_ratio;
    log_ratio_sq += error.log_ratio_sq;
    difference_sq += error.difference_sq;
    abs_log += error.abs_log * error.positive_channels;
    positive += error.positive_channels;
  }
  const auto count = static_cast<double>(errors.size());
  figures.log_cos /= count;
  figures.relative = std::expm1(log_ratio / count);
  figures.rms_log = std::sqrt(log_ratio_sq / count);
  figures.rms = std::sqrt(difference_sq / count);
  figures.mean_abs_log = positive > 0 ? abs_log / positive : 0;
  figures.unknown_fraction = 1 - count / static_cast<double>(options_.count);

  // pictures
  const SpherePictures shown = pictures(model);
  for (std::size_t i = 0; i < shown.shown.size(); ++i) {
    figures.ssim += ssim(pictures_.shown[i], shown.shown[i]) / static_cast<double>(shown.shown.size());
    figures.unknown_pixels += static_cast<std::size_t>(std::ranges::count(pictures_.spheres[i].known, 0));
  }
  figures.psnr = picture_psnr(shown);
  return figures;
}

ErrorFigures error_figures(BrdfRef reference, BrdfRef model, const FigureOptions& options) {
  return Scorer(reference, options).score(model);
}

}  // namespace burnish
