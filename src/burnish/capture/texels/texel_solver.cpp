#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/capture/texels/texel_lanes.h>
#include <burnish/capture/texels/texel_solver.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

constexpr std::size_t kBlock = kTexelLanes;
constexpr double kRidge = 1e-6;  // of the mean diagonal
// A pixel's error counts as that of x^(1/2), x = exposure f cos; below this x as if it were this.
constexpr float kFloor = 0.004f;
// Lobes may run away where nothing holds them: squares of their values stay finite.
constexpr float kMaxValue = 1e4f;
// Errors of the root at which a pixel counts a quarter, pass by pass.
constexpr std::array<float, 3> kTrustedError{1e6f, 0.2f, 0.08f};
// Shadows are darker than a model: what is brighter is rather a highlight that lobes lack yet, trusted four times as
// far.
constexpr float kBrighter = 1.0f / 16;
constexpr float kNormalDelta = 0.01f;  // of finite differences
constexpr double kMaxSlope = 0.95;     // length of a normal's x and y
constexpr double kMaxStep = 0.15;
constexpr double kDamping = 1e-2, kEase = 0.4, kHarden = 8;

Vec3 normal_of(const float* xy) noexcept {
  const double x = static_cast<double>(xy[0]), y = static_cast<double>(xy[1]);
  return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
}

/// The least of w' a w / 2 - b' w with w >= 0, by unknowns that are set free one by one [LawsonHanson1974].
class ActiveSet {
 public:
  ActiveSet(std::span<const double> a, std::span<const double> b, std::span<double> w) noexcept
      : a_(a), b_(b), w_(w), n_(b.size()) {}

  /// From the unknowns of w that are not 0.
  void start_near() noexcept {
    for (std::size_t i = 0; i < n_; ++i) free_[i] = w_[i] > 0;
    settle();
  }

  void run() noexcept {
    while (changes_ < 3 * n_) {
      const std::size_t next = steepest();
      if (next == n_) return;
      free_[next] = true;
      settle();
    }
  }

 private:
  static constexpr double kMinSquare = 1e-300, kMinSlope = 1e-12;

  /// The unknown at 0 that the sum falls by fastest; their number where there is none.
  std::size_t steepest() const noexcept {
    std::size_t best = n_;
    double most = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (free_[i]) continue;
      double slope = b_[i];
      for (std::size_t j = 0; j < n_; ++j) slope -= a_[i * n_ + j] * w_[j];
      const double scaled = slope / std::sqrt(std::max(a_[i * n_ + i], kMinSquare));
      if (scaled > most && slope > kMinSlope * std::abs(b_[i])) {
        most = scaled;
        best = i;
      }
    }
    return best;
  }

  /// The least for the free unknowns, by Cholesky.
  void solve_free() noexcept {
    std::size_t m = 0;
    for (std::size_t i = 0; i < n_; ++i)
      if (free_[i]) member_[m++] = i;
    for (std::size_t i = 0; i < m; ++i) {
      double rest = b_[member_[i]];
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = a_[member_[i] * n_ + member_[j]];
        for (std::size_t k = 0; k < j; ++k) sum -= factor_[i][k] * factor_[j][k];
        factor_[i][j] = i == j ? std::sqrt(std::max(sum, kMinSquare)) : sum * inverse_[j];
      }
      inverse_[i] = 1 / factor_[i][i];
      for (std::size_t k = 0; k < i; ++k) rest -= factor_[i][k] * solution_[member_[k]];
      solution_[member_[i]] = rest * inverse_[i];
    }
    for (std::size_t i = m; i-- > 0;) {
      double rest = solution_[member_[i]];
      for (std::size_t k = i + 1; k < m; ++k) rest -= factor_[k][i] * solution_[member_[k]];
      solution_[member_[i]] = rest * inverse_[i];
    }
  }

  /// Goes there as far as all stay positive; what would not is fixed at 0, and so on.
  void settle() noexcept {
    while (changes_ < 3 * n_) {
      ++changes_;
      solve_free();
      double step = 1;
      std::size_t blocking = n_;
      for (std::size_t i = 0; i < n_; ++i)
        if (free_[i] && solution_[i] <= 0) {
          const double share = w_[i] > solution_[i] ? w_[i] / (w_[i] - solution_[i]) : 0;
          if (share < step || blocking == n_) {
            step = share;
            blocking = i;
          }
        }
      for (std::size_t i = 0; i < n_; ++i)
        if (free_[i]) w_[i] += step * (solution_[i] - w_[i]);
      if (blocking == n_) break;
      free_[blocking] = false;
      w_[blocking] = 0;
    }
  }

  static constexpr std::size_t kMax = kMaxSurfaceLobes;
  std::span<const double> a_, b_;
  std::span<double> w_;
  std::size_t n_, changes_ = 0;
  std::array<bool, kMax> free_{};
  std::array<double, kMax> solution_{};
  std::array<std::array<double, kMax>, kMax> factor_;
  std::array<double, kMax> inverse_;  // of the factor's diagonal
  std::array<std::size_t, kMax> member_;
};

}  // namespace

void solve_nonnegative(std::span<const double> a, std::span<const double> b, std::span<double> w,
                       bool near) noexcept {
  const auto finite = [](double value) { return std::isfinite(value); };
  const bool sound = std::ranges::all_of(b, finite) && std::ranges::all_of(a, finite);
  if (!near || !sound) std::ranges::fill(w, 0.0);
  if (!sound) return;
  ActiveSet set(a, b, w);
  if (near) set.start_near();
  set.run();
}

TexelSamples samples_of(CaptureRows rows) {
  TexelSamples samples{.texels = {},
                       .pictures = rows.pictures,
                       .values = std::move(rows.values),
                       .states = std::move(rows.states),
                       .directions = std::move(rows.directions)};
  for (int y = 0; y < rows.rows; ++y)
    for (int x = 0; x < rows.width; ++x) samples.texels.push_back({x, rows.first_row + y});
  return samples;
}

TexelSamples every(const TexelSamples& all, std::size_t step) {
  TexelSamples some{.texels = {}, .pictures = all.pictures, .values = {}, .states = {}};
  for (std::size_t t = 0; t < all.size(); t += step) some.texels.push_back(all.texels[t]);
  const auto append = [](auto& to, const auto& from, std::size_t pixel, std::size_t count) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(count * pixel);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(count));
  };
  for (std::size_t p = 0; p < all.pictures; ++p)
    for (std::size_t t = 0; t < all.size(); t += step) {
      const std::size_t pixel = p * all.size() + t;
      append(some.values, all.values, pixel, 3);
      some.states.push_back(all.states[pixel]);
      if (!all.directions.empty()) append(some.directions, all.directions, pixel, 6);
    }
  return some;
}

TexelSolver::TexelSolver(const FactoredBrdf& lobes, const CaptureForm& form, double exposure)
    : evaluator_(lobes), form_(form), exposure_(exposure) {}

/// Some texels side by side, and room for what is computed of them.
class TexelSolver::Block {
 public:
  Block(const TexelSolver& solver, const TexelSamples& samples, bool held_out)
      : solver_(solver),
        samples_(samples),
        lobes_(solver.lobes()),
        exposure_(static_cast<float>(solver.exposure_)) {
    const auto& pictures = solver.form_.pictures;
    for (std::size_t p = 0; p < pictures.size(); ++p)
      if (pictures[p].held_out == held_out) pictures_.push_back(p);
    model_.resize(pictures_.size() * lobes_ * kCaptureChannels * kBlock);
    lobe_values_.resize(kPicturesTogether * lobes_ * kCaptureChannels * kBlock);
    trust_.resize(pictures_.size() * kBlock, 1);
    weights_.resize(lobes_);
    values_.resize(pictures_.size() * kCaptureChannels);
    states_.resize(pictures_.size());
    there_.resize(pictures_.size());
    clipped_.resize(values_.size());
  }

  std::span<const std::size_t> pictures() const noexcept { return pictures_; }
  std::size_t count() const noexcept { return count_; }

  void begin(std::size_t first, std::size_t count, const float* normals) {
    first_ = first;
    const bool same_places = solver_.form_.directional() && !normals;
    const bool known = same_places && evaluated_;  // all blocks see the same directions
    count_ = count;
    std::ranges::fill(trust_, 1.0f);
    load();
    if (known) return;
    evaluate(normals, 0, 0, model_);
    evaluated_ = true;
  }

  /// f cos(theta_i) of the lobes under normals moved by (dx, dy), [picture][lobe][channel][texel].
  void evaluate(const float* normals, float dx, float dy, std::vector<float>& to) {
    find_frames(normals, dx, dy);
    const std::size_t rows = lobes_ * kCaptureChannels;
    for (std::size_t first = 0; first < pictures_.size(); first += kPicturesTogether) {
      const std::size_t count = std::min(kPicturesTogether, pictures_.size() - first), pairs = count * kBlock;
      for (std::size_t k = 0; k < count; ++k) look(first + k, k * kBlock);
      const auto plane = [&](std::size_t r) { return std::span<const float>(local_[r]).first(pairs); };
      const std::span<float> f = std::span(lobe_values_).first(rows * pairs);
      solver_.evaluator_.eval(DirectionSpans{plane(0), plane(1), plane(2), plane(3), plane(4), plane(5)}, f);
      for (std::size_t k = 0; k < count; ++k)
        find_products(rows, &f[k * kBlock], pairs, &local_[2][k * kBlock], kMaxValue / exposure_,
                      &to[(first + k) * rows * kBlock]);
    }
  }

  /// Least squares for the weights, each pass trusting pixels by the errors that the one before left.
  void fit_weights(int passes, int first_pass) {
    for (int pass = 0; pass < passes; ++pass) {
      gram(pass + first_pass);
      const bool near = pass + first_pass > 0;
      const std::uint32_t found =
          find_weights(lobes_, matrix_.data(), vector_.data(), kRidge, near, weights_.data());
      std::array<double, kMaxSurfaceLobes * kMaxSurfaceLobes> a;
      std::array<double, kMaxSurfaceLobes> b, w;
      for (std::size_t i = 0; i < count_; ++i) {
        if ((found >> i & 1U) != 0) continue;
        double trace = 0;
        for (std::size_t k = 0, at = 0; k < lobes_; ++k) {
          for (std::size_t l = 0; l <= k; ++l, ++at)
            a[k * lobes_ + l] = a[l * lobes_ + k] = static_cast<double>(matrix_[at][i]);
          b[k] = static_cast<double>(vector_[k][i]);
          trace += a[k * lobes_ + k];
        }
        for (std::size_t k = 0; k < lobes_; ++k) {
          a[k * lobes_ + k] += kRidge * trace / static_cast<double>(lobes_) + 1e-30;
          w[k] = static_cast<double>(weights_[k][i]);
        }
        solve_nonnegative(std::span(a).first(lobes_ * lobes_), std::span(b).first(lobes_),
                          std::span(w).first(lobes_), near);
        for (std::size_t k = 0; k < lobes_; ++k) weights_[k][i] = static_cast<float>(w[k]);
      }
    }
  }

  /// Normals and weights from where they are, by damped steps; those that lead up are taken back, texel by texel.
  void find_normals(float* normals, int steps) {
    std::vector<float> best_weights(count_ * lobes_), best_normals(2 * count_);
    std::array<double, kBlock> best, damping;
    best.fill(INFINITY);
    damping.fill(kDamping);
    for (int step = 0; step <= steps; ++step) {
      if (step > 0) {
        step_normals(normals, damping);
        fit_weights(1, 2);
      }
      const std::array<double, kBlock> found = costs();
      bool taken_back = false;
      for (std::size_t i = 0; i < count_; ++i) {
        float* const n = normals + 2 * (first_ + i);
        const std::span<float> kept(&best_weights[i * lobes_], lobes_);
        if (found[i] < best[i]) {
          best[i] = found[i];
          damping[i] *= kEase;
          for (std::size_t j = 0; j < lobes_; ++j) kept[j] = weights_[j][i];
          std::copy_n(n, 2, &best_normals[2 * i]);
        } else {
          damping[i] *= kHarden;
          taken_back = true;
          for (std::size_t j = 0; j < lobes_; ++j) weights_[j][i] = kept[j];
          std::copy_n(&best_normals[2 * i], 2, n);
        }
      }
      if (taken_back) evaluate(normals, 0, 0, model_);
    }
  }

  /// What is left of the pixels of each texel, as weights count it.
  std::array<double, kBlock> costs() const {
    std::array<double, kBlock> sums{};
    for (std::size_t k = 0; k < pictures_.size(); ++k)
      for (std::size_t c = 0; c < kCaptureChannels; ++c) {
        const Terms terms = terms_of(k, c, 0);
        constexpr float kReach = 0.08f * 0.08f;
        for (std::size_t i = 0; i < kBlock; ++i) {
          const float rest = terms.value[i] - terms.model[i], square = terms.omega[i] * rest * rest;
          sums[i] += static_cast<double>(square / (1 + square / kReach));
        }
      }
    return sums;
  }

  void load_weights(const float* weights) {
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t k = 0; k < lobes_; ++k) weights_[k][i] = weights[(first_ + i) * lobes_ + k];
  }
  float weight(std::size_t i, std::size_t lobe) const noexcept { return weights_[lobe][i]; }
  float trust(std::size_t k, std::size_t i) const noexcept { return trust_[k * kBlock + i]; }
  /// The model's f cos(theta_i) of one picture and channel.
  TexelRow values(std::size_t k, std::size_t c) const noexcept {
    TexelRow total;
    sum_lobes(pixels(k, c), weights_.data(), total.data());
    return total;
  }
  const TexelRow& measured(std::size_t k, std::size_t c) const noexcept {
    return values_[k * kCaptureChannels + c];
  }
  std::size_t texel(std::size_t i) const noexcept { return first_ + std::min(i, count_ - 1); }
  std::size_t pixel(std::size_t k, std::size_t i) const noexcept {
    return pictures_[k] * samples_.size() + texel(i);
  }

  /// Trust in pixels by the errors that are left.
  void find_trust(int pass) { gram(pass); }

 private:
  void find_frames(const float* normals, float dx, float dy) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const std::size_t t = texel(i);
      const Vec3 point = solver_.form_.point(samples_.texels[t][0], samples_.texels[t][1]);
      points_[0][i] = static_cast<float>(point.x);
      points_[1][i] = static_cast<float>(point.y);
      points_[2][i] = static_cast<float>(point.z);
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

  /// Light and view of picture k as the texels see them, from `first` on in the rows of local_.
  void look(std::size_t k, std::size_t first) {
    const CapturePicture& picture = solver_.form_.pictures[pictures_[k]];
    for (const std::size_t which : {0, 1}) {
      const Station& station = which == 0 ? picture.light : picture.view;
      const bool known = !samples_.directions.empty(), any_length = !known && !station.is_direction;
      float* const to = &local_[3 * which][first];
      if (known)
        for (std::size_t i = 0; i < kBlock; ++i)
          for (std::size_t r = 0; r < 3; ++r)
            towards_[r][i] = samples_.directions[6 * pixel(k, i) + 3 * which + r];
      else
        find_towards(station);
      turn_into(frames_, towards_, any_length, to, kPicturesTogether * kBlock);
    }
  }

  /// Vectors towards a station, not of length 1 where it is a point: in units in which no square overflows.
  void find_towards(const Station& station) {
    const std::array<double, 3> at{station.at.x, station.at.y, station.at.z};
    const CaptureForm& form = solver_.form_;
    const double unit =
        station.is_direction ? 1 : 1 / std::max({length(station.at), form.size_x, form.size_y});
    const float share = station.is_direction ? 0 : static_cast<float>(unit);
    for (std::size_t r = 0; r < 3; ++r) {
      const auto from = static_cast<float>(unit * at[r]);
      for (std::size_t i = 0; i < kBlock; ++i) towards_[r][i] = from - share * points_[r][i];
    }
  }

  struct Terms {
    TexelRow value, model, omega;  // of one picture and channel
  };
  // omega: see find_omega, of the mean of measured and modelled value; 0 of what does not count.
  Terms terms_of(std::size_t k, std::size_t c, int pass) const {
    Terms terms{.value = values_[k * kCaptureChannels + c], .model = values(k, c), .omega = {}};
    TexelRow share, at;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const bool above = is_clipped(states_[k][i], c) && pass > 0 && terms.model[i] > terms.value[i];
      share[i] = is_there(states_[k][i]) && !above ? 1.0f : 0.0f;
      at[i] = pass == 0 ? terms.value[i] : 0.5f * (terms.value[i] + terms.model[i]);
    }
    find_omega(exposure_, kFloor, at.data(), share.data(), terms.omega.data());
    return terms;
  }

  /// A damped step of every normal, weights free to follow: Gauss and Newton's for both, weights eliminated.
  void step_normals(float* normals, const std::array<double, kBlock>& damping) {
    if (slopes_[0].empty())
      for (auto& slope : slopes_) slope.resize(model_.size());
    evaluate(normals, kNormalDelta, 0, slopes_[0]);
    evaluate(normals, 0, kNormalDelta, slopes_[1]);
    gram(static_cast<int>(kTrustedError.size()) - 1);
    const NormalSums sums = normal_sums();
    for (std::size_t i = 0; i < count_; ++i) {
      Eigen::Matrix2d a;
      a << sums.xx[i], sums.xy[i], sums.xy[i], sums.yy[i];
      const double damp = damping[i] * a.trace() + 1e-30;
      a -= eliminated(i, sums);
      a.diagonal().array() += damp;
      const Eigen::Vector2d way =
          static_cast<double>(kNormalDelta) * a.ldlt().solve(Eigen::Vector2d(sums.x[i], sums.y[i]));
      if (!way.allFinite()) continue;
      const double step = std::min(1.0, kMaxStep / std::max(way.norm(), 1e-12));
      float* const n = normals + 2 * (first_ + i);
      const double x = static_cast<double>(n[0]) + step * way.x(),
                   y = static_cast<double>(n[1]) + step * way.y();
      const double within = std::min(1.0, kMaxSlope / std::max(std::hypot(x, y), 1e-12));
      n[0] = static_cast<float>(within * x);
      n[1] = static_cast<float>(within * y);
    }
    evaluate(normals, 0, 0, model_);
  }

  using Sums = std::array<double, kBlock>;
  /// Of a texel's normal: matrix, right side, and products with the weights, by differences of kNormalDelta.
  struct NormalSums {
    Sums xx{}, xy{}, yy{}, x{}, y{};
    std::vector<Sums> cross_x, cross_y;  // [lobe]
  };
  NormalSums normal_sums() const {
    NormalSums sums;
    sums.cross_x.resize(lobes_);
    sums.cross_y.resize(lobes_);
    for (std::size_t k = 0; k < pictures_.size(); ++k)
      for (std::size_t c = 0; c < kCaptureChannels; ++c) {
        const Terms terms = terms_of(k, c, static_cast<int>(kTrustedError.size()) - 1);
        const std::size_t first = (k * lobes_ * kCaptureChannels + c) * kBlock,
                          stride = kCaptureChannels * kBlock;
        for (std::size_t i = 0; i < kBlock; ++i) {
          float sx = 0, sy = 0;
          for (std::size_t j = 0; j < lobes_; ++j) {
            const std::size_t at = first + j * stride + i;
            sx += weights_[j][i] * (slopes_[0][at] - model_[at]);
            sy += weights_[j][i] * (slopes_[1][at] - model_[at]);
          }
          const float omega = terms.omega[i] * trust_[k * kBlock + i], rest = terms.value[i] - terms.model[i];
          sums.xx[i] += static_cast<double>(omega * sx * sx);
          sums.xy[i] += static_cast<double>(omega * sx * sy);
          sums.yy[i] += static_cast<double>(omega * sy * sy);
          sums.x[i] += static_cast<double>(omega * sx * rest);
          sums.y[i] += static_cast<double>(omega * sy * rest);
          for (std::size_t j = 0; j < lobes_; ++j) {
            const float lobe = omega * model_[first + j * stride + i];
            sums.cross_x[j][i] += static_cast<double>(lobe * sx);
            sums.cross_y[j][i] += static_cast<double>(lobe * sy);
          }
        }
      }
    return sums;
  }

  /// What of a texel's matrix of the normal goes into weights that follow it: those that are not 0.
  Eigen::Matrix2d eliminated(std::size_t i, const NormalSums& sums) const {
    constexpr int kMax = static_cast<int>(kMaxSurfaceLobes);
    constexpr double kAlike = 1e-4;  // lobes may be alike
    std::array<std::size_t, kMaxSurfaceLobes> free;
    Eigen::Index count = 0;
    for (std::size_t j = 0; j < lobes_; ++j)
      if (weights_[j][i] > 0) free[static_cast<std::size_t>(count++)] = j;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMax, kMax> own(count, count);
    Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::ColMajor, kMax, 2> with(count, 2);
    for (Eigen::Index r = 0; r < count; ++r) {
      const std::size_t j = free[static_cast<std::size_t>(r)];
      for (Eigen::Index q = 0; q <= r; ++q)
        own(r, q) = own(q, r) =
            static_cast<double>(matrix_[j * (j + 1) / 2 + free[static_cast<std::size_t>(q)]][i]);
      with(r, 0) = sums.cross_x[j][i];
      with(r, 1) = sums.cross_y[j][i];
    }
    own.diagonal().array() += kAlike * own.trace() + 1e-30;
    return with.transpose() * own.ldlt().solve(with);
  }

  /// What was measured, as rows.
  void load() {
    any_clipped_ = false;
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      const PixelState* const states = &samples_.states[pixel(k, 0)];
      TexelRow *const values = &values_[k * kCaptureChannels], *const clipped =
                                                                   &clipped_[k * kCaptureChannels];
      for (std::size_t c = 0; c < kCaptureChannels; ++c) clipped[c].fill(0);
      if (count_ == kBlock) {
        take_apart(&samples_.values[pixel(k, 0) * kCaptureChannels], values);
      } else {
        for (std::size_t i = 0; i < kBlock; ++i)
          for (std::size_t c = 0; c < kCaptureChannels; ++c)
            values[c][i] = samples_.values[pixel(k, i) * kCaptureChannels + c];
      }
      if (std::all_of(states, states + count_, [](PixelState state) { return state == PixelState::there; })) {
        states_[k].fill(PixelState::there);  // and none is clipped, as was filled in above
        there_[k].fill(1);
        continue;
      }
      for (std::size_t i = 0; i < kBlock; ++i) {
        const PixelState state = samples_.states[pixel(k, i)];
        states_[k][i] = state;
        there_[k][i] = is_there(state) ? 1.0f : 0.0f;
        any_clipped_ = any_clipped_ || is_clipped(state);
        for (std::size_t c = 0; c < kCaptureChannels; ++c) clipped[c][i] = is_clipped(state, c) ? 1.0f : 0.0f;
      }
    }
  }

  TexelPixels pixels(std::size_t k, std::size_t c) const noexcept {
    return {.lobes = lobes_,
            .model = &model_[(k * lobes_ * kCaptureChannels + c) * kBlock],
            .stride = kCaptureChannels * kBlock,
            .value = values_[k * kCaptureChannels + c].data()};
  }

  void gram(int pass) {
    if (pictures_.empty()) {
      for (auto& row : matrix_) row.fill(0);
      for (auto& row : vector_) row.fill(0);
      return;
    }
    const float reach = kTrustedError[std::min(static_cast<std::size_t>(pass), kTrustedError.size() - 1)];
    find_normal_equations({.lobes = lobes_,
                           .channels = kCaptureChannels,
                           .pictures = pictures_.size(),
                           .model = model_.data(),
                           .value = values_.front().data(),
                           .there = there_.front().data(),
                           .clipped = any_clipped_ ? clipped_.front().data() : nullptr},
                          {.of_measured = pass == 0,
                           .exposure = exposure_,
                           .floor = kFloor,
                           .reach = reach,
                           .brighter = kBrighter},
                          weights_.data(), trust_.data(), matrix_.data(), vector_.data());
  }

  static constexpr std::size_t kPicturesTogether = 4;  // that lobes are evaluated for

  const TexelSolver& solver_;
  const TexelSamples& samples_;
  std::size_t lobes_, first_ = 0, count_ = 0;
  float exposure_;
  bool evaluated_ = false;
  std::vector<std::size_t> pictures_;
  std::vector<float> model_, trust_;
  std::vector<TexelRow> weights_, values_, there_, clipped_;
  bool any_clipped_ = false;
  std::vector<std::array<PixelState, kBlock>> states_;
  std::array<std::vector<float>, 2> slopes_;
  // of evaluate()
  TexelFrames frames_;
  std::array<TexelRow, 3> points_, towards_;
  std::array<std::array<float, kPicturesTogether * kBlock>, 6> local_;
  std::vector<float> lobe_values_;
  std::array<TexelRow, kMaxSurfaceLobes*(kMaxSurfaceLobes + 1) / 2> matrix_;
  std::array<TexelRow, kMaxSurfaceLobes> vector_;
};

namespace {

constexpr std::size_t kBlocksTogether = 8;  // of one thread, sharing what is allocated

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
  for_each_chunk(samples.size(), kBlock * kBlocksTogether,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   const auto block = std::make_unique<Block>(*this, samples, false);
                   for (std::size_t first = begin; first < end; first += kBlock) {
                     const std::size_t count = std::min(kBlock, end - first);
                     block->begin(first, count, xy);
                     block->fit_weights(options.normals ? 1 : options.passes, 0);
                     if (options.normals) {
                       block->find_normals(xy, options.normal_steps);
                       block->fit_weights(options.passes, 1);
                     }
                     for (std::size_t i = 0; i < count; ++i)
                       for (std::size_t j = 0; j < lobes(); ++j)
                         fits.weights[(first + i) * lobes() + j] = block->weight(i, j);
                     if (options.costs)
                       std::ranges::copy_n(block->costs().begin(), static_cast<std::ptrdiff_t>(count),
                                           &fits.costs[first]);
                     if (!options.trust) continue;
                     block->find_trust(static_cast<int>(kTrustedError.size()) - 1);
                     for (std::size_t k = 0; k < block->pictures().size(); ++k)
                       for (std::size_t i = 0; i < count; ++i)
                         fits.trust[block->pixel(k, i)] = block->trust(k, i);
                   }
                 });
  return fits;
}

std::vector<TexelSolver::PictureError> TexelSolver::errors(const TexelSamples& samples,
                                                           const TexelFits& fits) const {
  const float* const xy = fits.normals.empty() ? nullptr : fits.normals.data();
  const std::size_t chunk = kBlock * kBlocksTogether;
  std::vector<std::vector<PictureError>> partial(chunk_count(samples.size(), chunk));
  const auto exposure = static_cast<float>(exposure_);
  for_each_chunk(samples.size(), chunk, [&](std::size_t number, std::size_t begin, std::size_t end) {
    std::vector<PictureError>& errors = partial[number];
    errors.resize(samples.pictures);
    for (const bool held_out : {false, true}) {
      const auto block = std::make_unique<Block>(*this, samples, held_out);
      for (std::size_t first = begin; first < end; first += kBlock) {
        const std::size_t count = std::min(kBlock, end - first);
        block->begin(first, count, xy);
        block->load_weights(fits.weights.data());
        for (std::size_t k = 0; k < block->pictures().size(); ++k) {
          PictureError& error = errors[block->pictures()[k]];
          // what took the picture would clip the model too
          std::array<TexelRow, kCaptureChannels> seen, shown;
          for (std::size_t c = 0; c < kCaptureChannels; ++c) {
            const TexelRow& measured = block->measured(k, c);
            TexelRow model = block->values(k, c);
            for (std::size_t i = 0; i < count; ++i)
              if (is_clipped(samples.states[block->pixel(k, i)], c))
                model[i] = std::min(model[i], measured[i]);
            find_seen(exposure, measured.data(), seen[c].data());
            find_seen(exposure, model.data(), shown[c].data());
          }
          for (std::size_t i = 0; i < count; ++i) {
            const PixelState state = samples.states[block->pixel(k, i)];
            if (state == PixelState::missing) continue;
            double square = 0;
            for (std::size_t c = 0; c < kCaptureChannels; ++c) {
              const double off = static_cast<double>(seen[c][i]) - static_cast<double>(shown[c][i]);
              square += off * off;
            }
            const auto units = static_cast<std::uint64_t>(std::llround(square / PictureError::kUnit));
            error.all += units;
            error.all_count += kCaptureChannels;
            if (state == PixelState::masked) continue;
            error.seen += units;
            error.seen_count += kCaptureChannels;
          }
        }
      }
    }
  });
  std::vector<PictureError> sums(samples.pictures);
  for (const auto& part : partial)
    for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += part[p];
  return sums;
}

}  // namespace burnish
