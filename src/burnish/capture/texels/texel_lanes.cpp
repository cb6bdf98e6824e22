// SPDX-License-Identifier: Apache-2.0
#include <burnish/capture/texels/texel_lanes.h>
#include <burnish/surface/spatial_brdf.h>

#define HWY_TARGET_INCLUDE "burnish/capture/texels/texel_lanes.cpp"
#include <burnish/math/highway-inl.h>
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

using D = hn::CappedTag<float, kTexelLanes>;

constexpr float kLeastSquare = 1e-30f;  // shorter vectors have no direction

void turn_all(const TexelFrames& frames, const std::array<TexelRow, 3>& towards, bool any_length,
              float* local, std::size_t plane) {
  const D d;
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    auto x = hn::LoadU(d, towards[0].data() + i), y = hn::LoadU(d, towards[1].data() + i),
         z = hn::LoadU(d, towards[2].data() + i);
    if (any_length) {
      // The vector is divided by its length. A vector that is too short to have a direction becomes (0, 0, 1).
      const auto square = hn::MulAdd(z, z, hn::MulAdd(y, y, hn::Mul(x, x)));
      const auto inverse = hn::Div(hn::Set(d, 1.0f), hn::Sqrt(square));
      const auto far = hn::Ge(square, hn::Set(d, kLeastSquare));
      x = hn::IfThenElseZero(far, hn::Mul(x, inverse));
      y = hn::IfThenElseZero(far, hn::Mul(y, inverse));
      z = hn::IfThenElse(far, hn::Mul(z, inverse), hn::Set(d, 1.0f));
    }
    // Its component along each axis of the frame is their dot product.
    for (std::size_t r = 0; r < 3; ++r) {
      const TexelRow* const axis = &frames[3 * r];
      const auto along = hn::MulAdd(
          z, hn::LoadU(d, axis[2].data() + i),
          hn::MulAdd(y, hn::LoadU(d, axis[1].data() + i), hn::Mul(x, hn::LoadU(d, axis[0].data() + i))));
      hn::StoreU(along, d, local + r * plane + i);
    }
  }
}

void multiply_rows(std::size_t rows, const float* f, std::size_t plane, const float* cosine, float most,
                   float* product) {
  const D d;
  const auto limit = hn::Set(d, most);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    const auto factor = hn::LoadU(d, cosine + i);
    for (std::size_t r = 0; r < rows; ++r) {
      // The comparison is false for not-a-number, which therefore stays; Min would lose it.
      const auto value = hn::Mul(hn::LoadU(d, f + r * plane + i), factor);
      hn::StoreU(hn::IfThenElse(hn::Gt(value, limit), limit, value), d, product + r * kTexelLanes + i);
    }
  }
}

void values_apart(const float* values, TexelRow* rows) {
  const D d;
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    hn::Vec<D> a, b, c;
    hn::LoadInterleaved3(d, values + 3 * i, a, b, c);
    hn::StoreU(a, d, rows[0].data() + i);
    hn::StoreU(b, d, rows[1].data() + i);
    hn::StoreU(c, d, rows[2].data() + i);
  }
}

void sum_all(const TexelPixels& pixels, const TexelRow* weights, float* total) {
  const D d;
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    // The model is the sum of its lobes, each times the texel's weight.
    auto sum = hn::Zero(d);
    for (std::size_t j = 0; j < pixels.lobes; ++j)
      sum = hn::MulAdd(hn::LoadU(d, weights[j].data() + i),
                       hn::LoadU(d, pixels.model + j * pixels.stride + i), sum);
    hn::StoreU(sum, d, total + i);
  }
}

void omega_of(float exposure, float floor, const float* at, const float* share, float* omega) {
  const D d;
  const auto one = hn::Set(d, 1.0f), e = hn::Set(d, exposure),
             scale = hn::Set(d, 0.25f * exposure * exposure);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    // (d x^(1/2) / d value)^2 = e^2 / (4 x) up to 1; beyond it e^2 / (4 x^3), which meets it there.
    const auto x = hn::Max(hn::Mul(e, hn::LoadU(d, at + i)), hn::Set(d, floor));
    const auto under = hn::Mul(x, hn::Max(one, hn::Mul(x, x)));
    hn::StoreU(hn::Div(hn::Mul(scale, hn::LoadU(d, share + i)), under), d, omega + i);
  }
}

/// Implements find_normal_equations for `kLobes` lobes, so that sums stay in registers; 0: for any number.
template <std::size_t kLobes>
void equations_of(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights, float* trust,
                  TexelRow* matrix, TexelRow* vector) {
  const D d;
  using V = hn::Vec<D>;
  constexpr std::size_t kMax = kLobes > 0 ? kLobes : kMaxSurfaceLobes, kChannels = 3;
  const std::size_t lobes = kLobes > 0 ? kLobes : pictures.lobes, stride = pictures.channels * kTexelLanes;
  const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d), exposure = hn::Set(d, pass.exposure),
             floor = hn::Set(d, pass.floor), half = hn::Set(d, 0.5f),
             scale = hn::Set(d, 0.25f * pass.exposure * pass.exposure),
             square_reach = hn::Set(d, pass.reach * pass.reach), brighter = hn::Set(d, pass.brighter);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    V sums[kMax * (kMax + 1) / 2], right[kMax], weight[kMax];
    for (std::size_t j = 0; j < lobes; ++j) {
      right[j] = zero;
      weight[j] = hn::LoadU(d, weights[j].data() + i);
    }
    for (std::size_t at = 0; at < lobes * (lobes + 1) / 2; ++at) sums[at] = zero;
    for (std::size_t k = 0; k < pictures.pictures; ++k) {
      const float* const model = pictures.model + k * lobes * stride + i;
      const float* const values = pictures.value + k * stride + i;
      const auto there = hn::LoadU(d, pictures.there + k * kTexelLanes + i);
      // Each channel counts by omega, as in find_omega. The channel with the largest error decides the pixel's trust.
      V omega[kChannels];
      auto worst = zero;
      for (std::size_t c = 0; c < pictures.channels; ++c) {
        const auto value = hn::LoadU(d, values + c * kTexelLanes);
        auto at = value, share = there, rest = zero;
        if (!pass.of_measured) {
          // Omega is taken midway between the measured value and the model of the previous pass.
          auto total = zero;
          for (std::size_t j = 0; j < lobes; ++j)
            total = hn::MulAdd(weight[j], hn::LoadU(d, model + j * stride + c * kTexelLanes), total);
          at = hn::Mul(half, hn::Add(value, total));
          rest = hn::Sub(value, total);
          if (pictures.clipped) {
            // A clipped value is a lower bound: it does not count where the model is above it.
            const auto clipped = hn::LoadU(d, pictures.clipped + k * stride + c * kTexelLanes + i);
            share = hn::IfThenElse(hn::And(hn::Gt(clipped, zero), hn::Gt(total, value)), zero, share);
          }
        }
        const auto x = hn::Max(hn::Mul(exposure, at), floor);
        omega[c] = hn::Div(hn::Mul(scale, share), hn::Mul(x, hn::Max(one, hn::Mul(x, x))));
        if (pass.of_measured) continue;
        // Shadows are dark, so an error towards brighter counts less than one towards darker.
        const auto counts = hn::IfThenElse(hn::Lt(rest, zero), one, brighter);
        worst = hn::Max(worst, hn::Mul(hn::Mul(hn::Mul(counts, omega[c]), rest), rest));
      }
      auto trusted = one;
      if (!pass.of_measured) {
        // The weight of a robust loss: 1 / (1 + e / reach^2)^2 of the squared error e [GemanMcClure1987].
        const auto doubt = hn::Add(one, hn::Div(worst, square_reach));
        trusted = hn::IfThenElse(hn::Gt(there, zero), hn::Div(one, hn::Mul(doubt, doubt)), zero);
        hn::StoreU(trusted, d, trust + k * kTexelLanes + i);
      }
      // The matrix gains omega times products of two lobes; the right side gains omega times a lobe and the value.
      for (std::size_t c = 0; c < pictures.channels; ++c) {
        const auto value = hn::LoadU(d, values + c * kTexelLanes), counts = hn::Mul(omega[c], trusted);
        std::size_t at = 0;
        for (std::size_t j = 0; j < lobes; ++j) {
          const auto scaled = hn::Mul(counts, hn::LoadU(d, model + j * stride + c * kTexelLanes));
          right[j] = hn::MulAdd(scaled, value, right[j]);
          for (std::size_t l = 0; l <= j; ++l, ++at)
            sums[at] = hn::MulAdd(scaled, hn::LoadU(d, model + l * stride + c * kTexelLanes), sums[at]);
        }
      }
    }
    for (std::size_t j = 0; j < lobes; ++j) hn::StoreU(right[j], d, vector[j].data() + i);
    for (std::size_t at = 0; at < lobes * (lobes + 1) / 2; ++at)
      hn::StoreU(sums[at], d, matrix[at].data() + i);
  }
}

void all_equations(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights,
                   float* trust, TexelRow* matrix, TexelRow* vector) {
  const auto find = pictures.lobes == 1   ? equations_of<1>
                    : pictures.lobes == 2 ? equations_of<2>
                    : pictures.lobes == 3 ? equations_of<3>
                    : pictures.lobes == 4 ? equations_of<4>
                    : pictures.lobes == 5 ? equations_of<5>
                    : pictures.lobes == 6 ? equations_of<6>
                    : pictures.lobes == 8 ? equations_of<8>
                                          : equations_of<0>;
  find(pictures, pass, weights, trust, matrix, vector);
}

// The unknowns of texels side by side, in double. Each texel stands in a lane.
struct TexelUnknowns {
  using D64 = hn::CappedTag<double, kTexelLanes>;
  using V = hn::Vec<D64>;
  using M = hn::Mask<D64>;
  static constexpr std::size_t kMax = kMaxSurfaceLobes;
  static constexpr double kMinSquare = 1e-300, kMinSlope = 1e-12;

  std::size_t n;
  V a[kMax][kMax], b[kMax];  // a: the lower triangle
  M free[kMax];
  V solution[kMax];

  HWY_INLINE V matrix(std::size_t r, std::size_t c) const { return r < c ? a[c][r] : a[r][c]; }

  /// Finds the minimum over the free unknowns, by Cholesky; the other unknowns are 0.
  HWY_INLINE void solve_free() {
    const D64 d;
    const V one = hn::Set(d, 1.0), least = hn::Set(d, kMinSquare);
    V factor[kMax][kMax], inverse[kMax];
    // The matrix is L L^T. Each row of L is found together with its element of y, where L y = b. An unknown that is
    // not free has a row of the identity and 0 on the right, so that all lanes take the same steps.
    for (std::size_t r = 0; r < n; ++r) {
      V rest = hn::IfThenElseZero(free[r], b[r]);
      for (std::size_t c = 0; c < r; ++c) {
        V sum = hn::IfThenElseZero(hn::And(free[r], free[c]), a[r][c]);
        for (std::size_t k = 0; k < c; ++k) sum = hn::NegMulAdd(factor[r][k], factor[c][k], sum);
        factor[r][c] = hn::Mul(sum, inverse[c]);
        rest = hn::NegMulAdd(factor[r][c], solution[c], rest);
      }
      V square = hn::IfThenElse(free[r], a[r][r], one);
      for (std::size_t k = 0; k < r; ++k) square = hn::NegMulAdd(factor[r][k], factor[r][k], square);
      inverse[r] = hn::Div(one, hn::Sqrt(hn::Max(square, least)));
      solution[r] = hn::Mul(rest, inverse[r]);
    }
    // Then L^T x = y is solved from the last unknown to the first.
    for (std::size_t r = n; r-- > 0;) {
      V rest = solution[r];
      for (std::size_t k = r + 1; k < n; ++k) rest = hn::NegMulAdd(factor[k][r], solution[k], rest);
      solution[r] = hn::Mul(rest, inverse[r]);
    }
    for (std::size_t r = 0; r < n; ++r) solution[r] = hn::IfThenElseZero(free[r], solution[r]);
  }

  /// Sets free the unknowns that should be. True in lanes whose solution is the minimum over all w >= 0 and below
  /// `most`.
  HWY_INLINE M exchange(double most) {
    const D64 d;
    const V zero = hn::Zero(d);
    M good = hn::Eq(zero, zero);
    for (std::size_t r = 0; r < n; ++r) {
      // The slope b - A w is the rate at which the sum falls when this unknown grows.
      V slope = b[r];
      for (std::size_t c = 0; c < n; ++c) slope = hn::NegMulAdd(matrix(r, c), solution[c], slope);
      // The conditions of Karush, Kuhn and Tucker: a free unknown is positive, and the sum does not fall along one at
      // 0.
      const M level = hn::Le(slope, hn::Mul(hn::Set(d, kMinSlope), hn::Abs(b[r])));
      const M stays = hn::Or(hn::And(free[r], hn::Gt(solution[r], zero)), hn::AndNot(free[r], level));
      // All unknowns that break their condition change sides at once [PortugalJudiceVicente1994].
      free[r] = hn::Xor(free[r], hn::Not(stays));
      good = hn::And(good, hn::And(stays, hn::Lt(solution[r], hn::Set(d, most))));
    }
    return good;
  }
};

std::uint32_t weights_of(std::size_t lobes, const TexelRow* matrix, const TexelRow* vector, double ridge,
                         bool near, TexelRow* weights) {
  constexpr int kTurns = 8;             // few texels need more than four
  constexpr double kMostWeight = 1e30;  // larger weights are left to solve_nonnegative
  const TexelUnknowns::D64 d;
  const hn::Rebind<float, TexelUnknowns::D64> d32;
  using V = TexelUnknowns::V;
  std::uint32_t found = 0;
  TexelUnknowns unknowns{.n = lobes};
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    // The equations are solved in double: their squares span a wider range than floats resolve.
    V trace = hn::Zero(d), weight[TexelUnknowns::kMax];
    for (std::size_t r = 0, at = 0; r < lobes; ++r) {
      for (std::size_t c = 0; c <= r; ++c, ++at)
        unknowns.a[r][c] = hn::PromoteTo(d, hn::LoadU(d32, matrix[at].data() + i));
      unknowns.b[r] = hn::PromoteTo(d, hn::LoadU(d32, vector[r].data() + i));
      weight[r] = hn::PromoteTo(d, hn::LoadU(d32, weights[r].data() + i));
      trace = hn::Add(trace, unknowns.a[r][r]);
      unknowns.free[r] = near ? hn::Gt(weight[r], hn::Zero(d)) : hn::Eq(hn::Zero(d), hn::Zero(d));
    }
    // A ridge in proportion to the mean diagonal separates lobes that are alike.
    const V added = hn::MulAdd(hn::Set(d, ridge / static_cast<double>(lobes)), trace, hn::Set(d, 1e-30));
    for (std::size_t r = 0; r < lobes; ++r) unknowns.a[r][r] = hn::Add(unknowns.a[r][r], added);
    // The trace plus 0 times each right side is finite if the diagonal and all right sides are.
    V together = trace;
    for (std::size_t r = 0; r < lobes; ++r) together = hn::MulAdd(hn::Zero(d), unknowns.b[r], together);
    const auto sound = hn::IsFinite(together);
    // Turns go on until all texels are done. A texel keeps the weights of its last turn.
    auto done = hn::Not(sound);
    for (int turn = 0; turn < kTurns && !hn::AllTrue(d, done); ++turn) {
      unknowns.solve_free();
      const auto good = unknowns.exchange(kMostWeight);
      for (std::size_t r = 0; r < lobes; ++r)
        weight[r] = hn::IfThenElse(hn::AndNot(done, good), unknowns.solution[r], weight[r]);
      done = hn::Or(done, good);
    }
    // Texels that are not done keep their old weights. One bit a texel says which are done.
    for (std::size_t r = 0; r < lobes; ++r)
      hn::StoreU(hn::DemoteTo(d32, weight[r]), d32, weights[r].data() + i);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::And(done, sound), bits);
    found |= static_cast<std::uint32_t>(bits[0]) << i;
  }
  return found;
}

void seen_of(float exposure, const float* value, float* seen) {
  const D d;
  constexpr float kGrey = 1 / 2.2f, kMin = 1e-30f;
  const auto one = hn::Set(d, 1.0f), least = hn::Set(d, kMin), e = hn::Set(d, exposure);
  for (std::size_t i = 0; i < kTexelLanes; i += hn::Lanes(d)) {
    // x^(1/2.2) = exp(log(x) / 2.2). The result is 0 if x is too small for its logarithm.
    const auto x = hn::Min(hn::Mul(e, hn::LoadU(d, value + i)), one);
    const auto root = hn::Exp(d, hn::Mul(hn::Set(d, kGrey), hn::Log(d, hn::Max(x, least))));
    hn::StoreU(hn::IfThenElse(hn::Gt(x, least), root, hn::Zero(d)), d, seen + i);
  }
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(turn_all);
HWY_EXPORT(multiply_rows);
HWY_EXPORT(values_apart);
HWY_EXPORT(sum_all);
HWY_EXPORT(omega_of);
HWY_EXPORT(all_equations);
HWY_EXPORT(weights_of);
HWY_EXPORT(seen_of);

void turn_into(const TexelFrames& frames, const std::array<TexelRow, 3>& towards, bool any_length,
               float* local, std::size_t plane) noexcept {
  HWY_DYNAMIC_DISPATCH(turn_all)(frames, towards, any_length, local, plane);
}

void find_products(std::size_t rows, const float* f, std::size_t plane, const float* cosine, float most,
                   float* product) noexcept {
  HWY_DYNAMIC_DISPATCH(multiply_rows)(rows, f, plane, cosine, most, product);
}

void take_apart(const float* values, TexelRow* rows) noexcept {
  HWY_DYNAMIC_DISPATCH(values_apart)(values, rows);
}

void sum_lobes(const TexelPixels& pixels, const TexelRow* weights, float* total) noexcept {
  HWY_DYNAMIC_DISPATCH(sum_all)(pixels, weights, total);
}

void find_omega(float exposure, float floor, const float* at, const float* share, float* omega) noexcept {
  HWY_DYNAMIC_DISPATCH(omega_of)(exposure, floor, at, share, omega);
}

void find_normal_equations(const TexelPictures& pictures, const TexelPass& pass, const TexelRow* weights,
                           float* trust, TexelRow* matrix, TexelRow* vector) noexcept {
  HWY_DYNAMIC_DISPATCH(all_equations)(pictures, pass, weights, trust, matrix, vector);
}

std::uint32_t find_weights(std::size_t lobes, const TexelRow* matrix, const TexelRow* vector, double ridge,
                           bool near, TexelRow* weights) noexcept {
  return HWY_DYNAMIC_DISPATCH(weights_of)(lobes, matrix, vector, ridge, near, weights);
}

void find_seen(float exposure, const float* value, float* seen) noexcept {
  HWY_DYNAMIC_DISPATCH(seen_of)(exposure, value, seen);
}

}  // namespace burnish
#endif
