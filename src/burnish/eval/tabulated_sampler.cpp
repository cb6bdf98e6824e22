// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/eval/visible_half_scalar.h>

#define HWY_TARGET_INCLUDE "burnish/eval/tabulated_sampler.cpp"
#include <burnish/math/highway-inl.h>

#include <burnish/eval/one_draw-inl.h>
#include <burnish/eval/sampler_lanes-inl.h>

#ifndef BURNISH_EVAL_ONE_DRAW
#define BURNISH_EVAL_ONE_DRAW
namespace burnish {
/// SamplerView in floats, with the function that draws from it, for the instruction set chosen when the sampler was
/// made.
struct OneDraw {
  float sharpness = 0, share = 0, xx = 0, xy = 0, yy = 0, theta_scale = 0, last_ring = 0, turn_per_row = 0,
        per_column = 0, cells = 0;
  int thetas = 0, phis = 0, rows = 0, columns = 0;
  const std::uint16_t *row_edges = nullptr, *cell_edges = nullptr;
  DrawnDirection (*draw)(const OneDraw& view, const Vec3& wo, const Point2& u) = nullptr;

  OneDraw() = default;
  explicit OneDraw(const SamplerView& v)
      : thetas(v.thetas),
        phis(v.phis),
        rows(v.rows),
        columns(v.columns),
        row_edges(v.row_edges),
        cell_edges(v.cell_edges) {
    const double from[] = {v.sharpness,   v.share,     v.xx,           v.xy,         v.yy,
                           v.theta_scale, v.last_ring, v.turn_per_row, v.per_column, v.cells};
    float* const to[] = {&sharpness,   &share,     &xx,           &xy,         &yy,
                         &theta_scale, &last_ring, &turn_per_row, &per_column, &cells};
    for (std::size_t k = 0; k < std::size(from); ++k) *to[k] = static_cast<float>(from[k]);
  }
};
}  // namespace burnish
#endif

HWY_BEFORE_NAMESPACE();
BURNISH_BEGIN_TARGET;

// Calls body(in, out) on whole vectors, then on the rest through buffers filled up with 0. Unlike the loop of
// vector_loop-inl.h, it takes any count of outputs, which may be inputs.
template <std::size_t kIn, std::size_t kOut, class Body>
HWY_INLINE void for_each_vector(const float* const (&in)[kIn], float* const (&out)[kOut], std::size_t count,
                                const Body& body) {
  const D d;
  const std::size_t width = hn::Lanes(d);
  Reals from[kIn], to[kOut];
  std::size_t i = 0;
  for (; i + width <= count; i += width) {
    for (std::size_t k = 0; k < kIn; ++k) from[k] = Reals(hn::LoadU(d, in[k] + i));
    body(from, to);
    for (std::size_t k = 0; k < kOut; ++k) hn::StoreU(to[k].raw, d, out[k] + i);
  }
  if (i == count) return;
  float rest[hn::MaxLanes(D())] = {};
  for (std::size_t k = 0; k < kIn; ++k) {
    std::copy(in[k] + i, in[k] + count, rest);
    from[k] = Reals(hn::LoadU(d, rest));
  }
  body(from, to);
  for (std::size_t k = 0; k < kOut; ++k) {
    hn::StoreU(to[k].raw, d, rest);
    std::copy(rest, rest + (count - i), out[k] + i);
  }
}

template <bool kIsotropic>
void draw_all(const SamplerView& tables, const float* const (&in)[5], float* const (&out)[4],
              std::size_t count) {
  const SamplerView view = tables;
  for_each_vector(in, out, count, [&](const Reals(&from)[5], Reals(&to)[4]) HWY_ATTR {
    const auto wi = draw<kIsotropic, Reals, Ints>(view, from[0], from[1], from[2], from[3], from[4]);
    to[0] = wi.x;
    to[1] = wi.y;
    to[2] = wi.z;
    to[3] = wi.pdf;
  });
}

template <bool kIsotropic>
void density_all(const SamplerView& tables, const float* const (&in)[6], float* const (&out)[1],
                 std::size_t count) {
  const SamplerView view = tables;
  for_each_vector(in, out, count, [&](const Reals(&from)[6], Reals(&to)[1]) HWY_ATTR {
    to[0] = density<kIsotropic, Reals, Ints>(view, from[0], from[1], from[2], from[3], from[4], from[5]);
  });
}

void run_draw(bool isotropic, const SamplerView& view, const float* const (&in)[5], float* const (&out)[4],
              std::size_t count) {
  if (isotropic)
    draw_all<true>(view, in, out, count);
  else
    draw_all<false>(view, in, out, count);
}
void run_density(bool isotropic, const SamplerView& view, const float* const (&in)[6], float* const (&out)[1],
                 std::size_t count) {
  if (isotropic)
    density_all<true>(view, in, out, count);
  else
    density_all<false>(view, in, out, count);
}

template <bool kIsotropic>
DrawnDirection draw_one(const OneDraw& view, const Vec3& wo, const Point2& u) {
  const auto d = draw<kIsotropic, Real, Int>(view, Real(wo.x), Real(wo.y), Real(wo.z), Real(u.x), Real(u.y));
  return {{d.x.raw, d.y.raw, d.z.raw}, d.pdf.raw};
}
void choose_draw(bool isotropic, OneDraw& one) {
  one.draw = isotropic ? &draw_one<true> : &draw_one<false>;
}

BURNISH_END_TARGET;
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace burnish {

HWY_EXPORT(choose_draw);
HWY_EXPORT(run_draw);
HWY_EXPORT(run_density);

namespace {

constexpr double kSteepest = 0.01;  // least wo.z of the tables

// Returns the place of the last ring of wo: t / (kRingReach - t), t = tan(theta / 2).
double last_ring() noexcept {
  const double t = std::sqrt((1 - kSteepest) / (1 + kSteepest));
  return t / (scalar::kRingReach - t);
}

Vec3 wo_of(const SamplerOptions& options, int ring, int turn) noexcept {
  // Inverts the places of rings and azimuths that mix_for() of visible_half-inl.h defines.
  const double at = last_ring() * ring / (options.wo_thetas - 1), t = scalar::kRingReach * at / (1 + at);
  const double sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
  const double around = 4.0 * turn / options.wo_phis;
  const auto axis = scalar::on_half_circle(std::abs(around - 2) - 1, 2 - around);
  return {sine * axis.x / axis.length, sine * axis.y / axis.length, cosine};
}

// Appends cumulative masses in 1/65536, the first of them 0, with at least 1 for each cell.
void append_edges(std::vector<std::uint16_t>& edges, std::span<const double> masses) {
  double total = 0, before = 0;
  for (const double m : masses) total += m;
  // Every cell gets one unit; the rest is shared by mass, or evenly where there is none.
  const double free = 65536 - static_cast<double>(masses.size());
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double share =
        total > 0 ? before / total : static_cast<double>(i) / static_cast<double>(masses.size());
    edges.push_back(static_cast<std::uint16_t>(i + static_cast<std::size_t>(std::lround(free * share))));
    before += masses[i];
  }
}

}  // namespace

struct TabulatedSampler::Tables {
  bool isotropic;
  std::vector<std::uint16_t> row_edges, cell_edges;
  SamplerView view;
  OneDraw one_draw;

  Tables(BrdfRef brdf, const SamplerOptions& options) : isotropic(brdf.isotropic()) {
    const auto size = [](const char* name, int value, bool fits) {
      if (!fits) throw Error(fmt::format("sampler: expected a fitting count of {}, found {}", name, value));
    };
    const auto power = [](int n) {
      return n >= 8 && n <= 256 && std::has_single_bit(static_cast<unsigned>(n));
    };
    size("polar angles", options.wo_thetas, options.wo_thetas >= 2 && options.wo_thetas <= 256);
    size("azimuths", options.wo_phis,
         isotropic ? options.wo_phis == 1 : options.wo_phis >= 2 && options.wo_phis <= 256);
    size("rows", options.rows, power(options.rows));
    size("columns", options.columns, power(options.columns));

    // The map that suits this BRDF best is found first; the sizes of the tables follow.
    std::vector<double> f(brdf.channels());
    static_cast<VisibleHalfMap&>(view) = fit_map(brdf, options, f);
    view.thetas = options.wo_thetas;
    view.phis = options.wo_phis;
    view.rows = options.rows;
    view.columns = options.columns;
    view.turn_per_row = (isotropic ? 2.0 : 4.0) / view.rows;
    view.per_column = 1.0 / view.columns;
    view.last_ring = view.thetas - 1;
    view.theta_scale = view.last_ring / last_ring();
    view.cells = scalar::cells_per_unit(view.rows, view.columns);

    // One slice is tabulated for each wo. An edge of 0 follows the last, where 65536 would be.
    for (int ring = 0; ring < view.thetas; ++ring)
      for (int turn = 0; turn < view.phis; ++turn)
        if (isotropic)
          add_slice<true>(brdf, wo_of(options, ring, turn), f);
        else
          add_slice<false>(brdf, wo_of(options, ring, turn), f);
    row_edges.push_back(0);
    cell_edges.push_back(0);
    view.row_edges = row_edges.data();
    view.cell_edges = cell_edges.data();
    one_draw = OneDraw(view);
    HWY_DYNAMIC_DISPATCH(choose_draw)(isotropic, one_draw);
  }
  Tables(const Tables&) = delete;

  // Returns the size of the reflected light. For isotropic BRDFs it is the mean of both sides of the plane of wo, y =
  // 0: a measured BRDF need not be its own mirror image.
  double size_of(BrdfRef brdf, Vec3 wi, Vec3 wo, std::span<double> f) const {
    const double one = reflected_size(brdf, wi, wo, f);
    return isotropic ? 0.5 * (one + reflected_size(brdf, {wi.x, -wi.y, wi.z}, wo, f)) : one;
  }

  VisibleHalfMap fit_map(BrdfRef brdf, const SamplerOptions& options, std::span<double> f) const {
    std::vector<ReflectedLight> views;
    const int azimuths = isotropic ? 1 : 3;
    for (const double theta_deg : {15.0, 40.0, 60.0, 76.0, 84.0})
      for (int k = 0; k < azimuths; ++k) {
        ReflectedLight light{
            .wo = spherical_direction(radians(theta_deg), kPi * k / azimuths), .rule = {}, .size = {}};
        light.rule = half_vector_quadrature(light.wo, 64, 96);
        // wo lies in the x-z plane, so one side of it is enough.
        if (isotropic) std::erase_if(light.rule, [](const DirectionWeight& d) { return d.wi.y < 0; });
        for (const auto& [wi, weight] : light.rule) light.size.push_back(size_of(brdf, wi, light.wo, f));
        views.push_back(std::move(light));
      }
    return fit_visible_half_map(views, isotropic, options.rows, options.columns);
  }

  // Tabulates a mass for each cell of the map at wo: the root of the mean square of g, the reflected light in it.
  // Weights g / mass have the second moment sum of mean(g^2) / mass. Among all masses with one sum, this one
  // minimizes it. If g is constant in a cell, the mass is its mean.
  template <bool kIsotropic>
  void add_slice(BrdfRef brdf, Vec3 wo, std::span<double> f) {
    constexpr int kAcross = 4;  // points along each axis of a cell
    std::vector<double> rows, cells(static_cast<std::size_t>(view.columns));
    const double turn = (kIsotropic ? 2.0 : 4.0) / view.rows;
    for (int row = 0; row < view.rows; ++row) {
      double sum = 0;
      for (int column = 0; column < view.columns; ++column) {
        double squares = 0;
        for (int i = 0; i < kAcross; ++i)
          for (int j = 0; j < kAcross; ++j) {
            const auto wi = scalar::place<kIsotropic>(view, wo.x, wo.y, wo.z, scalar::arrow(wo.x, wo.y),
                                                      turn * (row + (i + 0.5) / kAcross),
                                                      (column + (j + 0.5) / kAcross) / view.columns, 1.0);
            if (!(wi.z > 0)) continue;
            // g is the reflected light per unit of turn and v: the value over the map's density.
            const double g = size_of(brdf, {wi.x, wi.y, wi.z}, wo, f) / wi.density;
            squares += g * g;
          }
        const double mass = std::sqrt(squares);
        cells[static_cast<std::size_t>(column)] = mass;
        sum += mass;
      }
      rows.push_back(sum);
      append_edges(cell_edges, cells);
    }
    append_edges(row_edges, rows);
  }
};

SamplerOptions default_sampler_options(bool isotropic) noexcept {
  return isotropic ? SamplerOptions{.wo_thetas = 16, .wo_phis = 1, .rows = 16, .columns = 16}
                   : SamplerOptions{.wo_thetas = 6, .wo_phis = 12, .rows = 16, .columns = 16};
}

TabulatedSampler::TabulatedSampler(BrdfRef brdf)
    : TabulatedSampler(brdf, default_sampler_options(brdf.isotropic())) {}

TabulatedSampler::TabulatedSampler(BrdfRef brdf, const SamplerOptions& options)
    : tables_(std::make_shared<const Tables>(brdf, options)) {}

DrawnDirection TabulatedSampler::sample_wi(Vec3 wo, Point2 u) const noexcept {
  return tables_->one_draw.draw(tables_->one_draw, wo, u);
}

double TabulatedSampler::pdf(Vec3 wi, Vec3 wo) const noexcept {
  return tables_->isotropic
             ? scalar::density<true, double, std::int32_t>(tables_->view, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z)
             : scalar::density<false, double, std::int32_t>(tables_->view, wi.x, wi.y, wi.z, wo.x, wo.y,
                                                            wo.z);
}

void TabulatedSampler::sample_wi(const DrawSpans& in, const DrawnSpans& out) const noexcept {
  const float* const from[5] = {in.wo_x.data(), in.wo_y.data(), in.wo_z.data(), in.u_x.data(), in.u_y.data()};
  float* const to[4] = {out.wi_x.data(), out.wi_y.data(), out.wi_z.data(), out.pdf.data()};
  HWY_DYNAMIC_DISPATCH(run_draw)(tables_->isotropic, tables_->view, from, to, in.size());
}

void TabulatedSampler::pdf(const DirectionSpans& in, std::span<float> pdf) const noexcept {
  const float* const from[6] = {in.wi_x.data(), in.wi_y.data(), in.wi_z.data(),
                                in.wo_x.data(), in.wo_y.data(), in.wo_z.data()};
  float* const to[1] = {pdf.data()};
  HWY_DYNAMIC_DISPATCH(run_density)(tables_->isotropic, tables_->view, from, to, in.size());
}

SamplerTables TabulatedSampler::tables() const noexcept {
  const SamplerView& view = tables_->view;
  return {
      tables_->isotropic, view.sharpness,     view.share, view.xx,      view.xy,          view.yy,
      view.thetas,        view.phis,          view.rows,  view.columns, view.theta_scale, scalar::kRingReach,
      tables_->row_edges, tables_->cell_edges};
}

std::size_t TabulatedSampler::bytes() const noexcept {
  return sizeof(std::uint16_t) * (tables_->row_edges.size() + tables_->cell_edges.size());
}

}  // namespace burnish
#endif
