// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>

#include <burnish/capture/texels/nonnegative.h>
#include <burnish/capture/texels/texel_block.h>

namespace burnish {

namespace {

constexpr double kRidge = 1e-6;  // times the mean diagonal
// A pixel's error counts as the error of x^(1/2), x = exposure f cos; smaller x are taken as this.
constexpr float kFloor = 0.004f;
// Lobes may grow without limit where no pixel holds them. Up to this value their squares stay finite.
constexpr float kMaxValue = 1e4f;
// Errors of the root at which a pixel counts a quarter, for each pass.
constexpr std::array<float, TexelBlock::kLastPass + 1> kTrustedError{1e6f, 0.2f, 0.08f};
// Shadows are darker than the model. A brighter pixel is rather a highlight that the lobes lack yet, so it is trusted
// up to four times the error.
constexpr float kBrighter = 1.0f / 16;

Vec3 normal_of(const float* xy) noexcept {
  const double x = static_cast<double>(xy[0]), y = static_cast<double>(xy[1]);
  return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
}

}  // namespace

// ---- LobeRows

LobeRows::LobeRows(const TexelSetting& setting, std::span<const std::size_t> pictures)
    : setting_(setting), pictures_(pictures), lobe_values_(kTogether * rows() * kTexelLanes) {}

void LobeRows::find(const TexelRange& range, const float* normals, float dx, float dy, std::span<float> to) {
  find_frames(range, normals, dx, dy);
  const std::size_t rows = this->rows();
  for (std::size_t first = 0; first < pictures_.size(); first += kTogether) {
    // The directions of a few pictures stand side by side, one texel after the other.
    const std::size_t count = std::min(kTogether, pictures_.size() - first), pairs = count * kTexelLanes;
    for (std::size_t k = 0; k < count; ++k) find_directions(range, pictures_[first + k], k * kTexelLanes);
    // The lobes are evaluated at all of them in one call.
    const auto plane = [&](std::size_t r) { return std::span<const float>(local_[r]).first(pairs); };
    const std::span<float> f = std::span(lobe_values_).first(rows * pairs);
    setting_.lobes.eval(DirectionSpans{plane(0), plane(1), plane(2), plane(3), plane(4), plane(5)}, f);
    // The values are multiplied by cos(theta_i), the z of the light.
    for (std::size_t k = 0; k < count; ++k)
      find_products(rows, &f[k * kTexelLanes], pairs, &local_[2][k * kTexelLanes],
                    kMaxValue / setting_.exposure, &to[(first + k) * rows * kTexelLanes]);
  }
}

void LobeRows::find_frames(const TexelRange& range, const float* normals, float dx, float dy) {
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    // Lights and views that are points are seen from the texel's place.
    const std::size_t t = range.texel(i);
    const Vec3 point = setting_.form.point(setting_.samples.texels[t][0], setting_.samples.texels[t][1]);
    points_[0][i] = static_cast<float>(point.x);
    points_[1][i] = static_cast<float>(point.y);
    points_[2][i] = static_cast<float>(point.z);
    // The frame stands about the texel's normal; flat normals have the surface's frame.
    ShadingFrame frame;
    if (normals) {
      const std::array<float, 2> xy{normals[2 * t] + dx, normals[2 * t + 1] + dy};
      frame = frame_about(normalize(normal_of(xy.data())), {1, 0, 0});
    }
    std::size_t row = 0;
    for (const Vec3& axis : {frame.tangent, frame.bitangent, frame.normal})
      for (const double component : {axis.x, axis.y, axis.z})
        frames_[row++][i] = static_cast<float>(component);
  }
}

/// Finds light and view of a picture in the texels' frames, from column `first` on in the rows of local_.
void LobeRows::find_directions(const TexelRange& range, std::size_t picture, std::size_t first) {
  const CapturePicture& form = setting_.form.pictures[picture];
  const TexelSamples& samples = setting_.samples;
  for (const std::size_t which : {0, 1}) {
    const Station& station = which == 0 ? form.light : form.view;
    const bool known = !samples.directions.empty(), any_length = !known && !station.is_direction;
    float* const to = &local_[3 * which][first];
    if (known) {
      // Each texel has directions of its own.
      for (std::size_t i = 0; i < kTexelLanes; ++i) {
        const std::size_t pixel = picture * samples.size() + range.texel(i);
        for (std::size_t r = 0; r < 3; ++r) towards_[r][i] = samples.directions[6 * pixel + 3 * which + r];
      }
    } else {
      find_towards(station);
    }
    turn_into(frames_, towards_, any_length, to, kTogether * kTexelLanes);
  }
}

/// Finds vectors towards a station, not of length 1 if it is a point. Their unit is such that no square overflows.
void LobeRows::find_towards(const Station& station) {
  const std::array<double, 3> at{station.at.x, station.at.y, station.at.z};
  const CaptureForm& form = setting_.form;
  const double unit = station.is_direction ? 1 : 1 / std::max({length(station.at), form.size_x, form.size_y});
  // A direction is the same from all texels, so their place is not subtracted.
  const float share = station.is_direction ? 0 : static_cast<float>(unit);
  for (std::size_t r = 0; r < 3; ++r) {
    const auto from = static_cast<float>(unit * at[r]);
    for (std::size_t i = 0; i < kTexelLanes; ++i) towards_[r][i] = from - share * points_[r][i];
  }
}

// ---- TexelBlock

namespace {

std::vector<std::size_t> pictures_of(const CaptureForm& form, bool held_out) {
  std::vector<std::size_t> pictures;
  for (std::size_t p = 0; p < form.pictures.size(); ++p)
    if (form.pictures[p].held_out == held_out) pictures.push_back(p);
  return pictures;
}

}  // namespace

TexelBlock::TexelBlock(const TexelSetting& setting, bool held_out)
    : setting_(setting),
      lobes_(setting.lobes.lobes()),
      pictures_(pictures_of(setting.form, held_out)),
      lobe_rows_(setting, pictures_),
      model_(pictures_.size() * lobe_rows_.rows() * kTexelLanes),
      trust_(pictures_.size() * kTexelLanes, 1),
      weights_(lobes_),
      values_(pictures_.size() * kCaptureChannels),
      there_(pictures_.size()),
      clipped_(values_.size()),
      states_(pictures_.size()) {}

void TexelBlock::begin(const TexelRange& range, const float* normals) {
  range_ = range;
  std::ranges::fill(trust_, 1.0f);
  load();
  // If all texels see the same directions, the lobes' values are known from the block before.
  const bool same_for_all = setting_.form.directional() && !normals;
  if (same_for_all && seen_) return;
  see(normals);
  seen_ = true;
}

/// Lays out the measured values as rows.
void TexelBlock::load() {
  any_clipped_ = false;
  for (std::size_t k = 0; k < pictures_.size(); ++k) {
    TexelRow* const values = &values_[k * kCaptureChannels];
    const std::size_t first = pixel(k, 0) * kCaptureChannels;
    if (range_.count == kTexelLanes) {
      take_apart(&setting_.samples.values[first], values);
    } else {
      for (std::size_t i = 0; i < kTexelLanes; ++i)
        for (std::size_t c = 0; c < kCaptureChannels; ++c)
          values[c][i] = setting_.samples.values[pixel(k, i) * kCaptureChannels + c];
    }
    load_states(k);
  }
}

void TexelBlock::load_states(std::size_t k) {
  const PixelState* const states = &setting_.samples.states[pixel(k, 0)];
  TexelRow* const clipped = &clipped_[k * kCaptureChannels];
  for (std::size_t c = 0; c < kCaptureChannels; ++c) clipped[c].fill(0);
  // Most pictures show all texels of a block, with no channel clipped.
  if (std::all_of(states, states + range_.count,
                  [](PixelState state) { return state == PixelState::there; })) {
    states_[k].fill(PixelState::there);
    there_[k].fill(1);
    return;
  }
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    const PixelState state = setting_.samples.states[pixel(k, i)];
    states_[k][i] = state;
    there_[k][i] = is_there(state) ? 1.0f : 0.0f;
    any_clipped_ = any_clipped_ || is_clipped(state);
    for (std::size_t c = 0; c < kCaptureChannels; ++c) clipped[c][i] = is_clipped(state, c) ? 1.0f : 0.0f;
  }
}

void TexelBlock::load_weights(const float* weights) {
  for (std::size_t i = 0; i < range_.count; ++i)
    for (std::size_t k = 0; k < lobes_; ++k) weights_[k][i] = weights[(range_.first + i) * lobes_ + k];
}

TexelRow TexelBlock::modelled(std::size_t k, std::size_t c) const noexcept {
  TexelRow total;
  sum_lobes({.lobes = lobes_,
             .model = &model_[(k * lobes_ * kCaptureChannels + c) * kTexelLanes],
             .stride = kCaptureChannels * kTexelLanes,
             .value = measured(k, c).data()},
            weights_.data(), total.data());
  return total;
}

void TexelBlock::find_equations(int pass) {
  if (pictures_.empty()) {
    for (auto& row : matrix_) row.fill(0);
    for (auto& row : vector_) row.fill(0);
    return;
  }
  find_normal_equations({.lobes = lobes_,
                         .channels = kCaptureChannels,
                         .pictures = pictures_.size(),
                         .model = model_.data(),
                         .value = values_.front().data(),
                         .there = there_.front().data(),
                         .clipped = any_clipped_ ? clipped_.front().data() : nullptr},
                        {.of_measured = pass == 0,
                         .exposure = setting_.exposure,
                         .floor = kFloor,
                         .reach = kTrustedError[static_cast<std::size_t>(std::min(pass, kLastPass))],
                         .brighter = kBrighter},
                        weights_.data(), trust_.data(), matrix_.data(), vector_.data());
}

void TexelBlock::fit_weights(int passes, int first_pass) {
  for (int pass = first_pass; pass < first_pass + passes; ++pass) {
    // The passes are reweighted least squares: a pixel's weight follows from the previous pass.
    find_equations(pass);
    // All texels are solved side by side. Texels whose exchange of unknowns did not end are solved one by one.
    const bool near = pass > 0;
    const std::uint32_t found =
        find_weights(lobes_, matrix_.data(), vector_.data(), kRidge, near, weights_.data());
    for (std::size_t i = 0; i < range_.count; ++i)
      if ((found >> i & 1U) == 0) solve_one_by_one(i, near);
  }
}

/// Finds the weights of one texel with solve_nonnegative.
void TexelBlock::solve_one_by_one(std::size_t i, bool near) {
  std::array<double, kMaxSurfaceLobes * kMaxSurfaceLobes> a;
  std::array<double, kMaxSurfaceLobes> b, w;
  // The lanes keep the lower triangle of the symmetric matrix.
  double trace = 0;
  for (std::size_t k = 0, at = 0; k < lobes_; ++k) {
    for (std::size_t l = 0; l <= k; ++l, ++at)
      a[k * lobes_ + l] = a[l * lobes_ + k] = static_cast<double>(matrix_[at][i]);
    b[k] = static_cast<double>(vector_[k][i]);
    trace += a[k * lobes_ + k];
  }
  // A ridge on the diagonal, the same as in find_weights, separates lobes that are alike.
  for (std::size_t k = 0; k < lobes_; ++k) {
    a[k * lobes_ + k] += kRidge * trace / static_cast<double>(lobes_) + 1e-30;
    w[k] = static_cast<double>(weights_[k][i]);
  }
  solve_nonnegative(std::span(a).first(lobes_ * lobes_), std::span(b).first(lobes_),
                    std::span(w).first(lobes_), near);
  for (std::size_t k = 0; k < lobes_; ++k) weights_[k][i] = static_cast<float>(w[k]);
}

TexelBlock::Terms TexelBlock::terms_of(std::size_t k, std::size_t c, int pass) const {
  Terms terms{.value = measured(k, c), .model = modelled(k, c), .omega = {}};
  TexelRow share, at;
  for (std::size_t i = 0; i < kTexelLanes; ++i) {
    // A clipped value is a lower bound: it counts while the model is below it.
    const bool above = is_clipped(states_[k][i], c) && pass > 0 && terms.model[i] > terms.value[i];
    share[i] = is_there(states_[k][i]) && !above ? 1.0f : 0.0f;
    at[i] = pass == 0 ? terms.value[i] : 0.5f * (terms.value[i] + terms.model[i]);
  }
  find_omega(setting_.exposure, kFloor, at.data(), share.data(), terms.omega.data());
  return terms;
}

std::array<double, kTexelLanes> TexelBlock::costs() const {
  std::array<double, kTexelLanes> sums{};
  for (std::size_t k = 0; k < pictures_.size(); ++k)
    for (std::size_t c = 0; c < kCaptureChannels; ++c) {
      const Terms terms = terms_of(k, c, 0);
      // The last pass minimizes this loss by reweighting: e / (1 + e / reach^2) of a squared error e
      // [GemanMcClure1987].
      constexpr float kReach = 0.08f * 0.08f;
      for (std::size_t i = 0; i < kTexelLanes; ++i) {
        const float rest = terms.value[i] - terms.model[i], square = terms.omega[i] * rest * rest;
        sums[i] += static_cast<double>(square / (1 + square / kReach));
      }
    }
  return sums;
}

}  // namespace burnish
