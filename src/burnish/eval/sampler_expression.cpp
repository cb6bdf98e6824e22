// SPDX-License-Identifier: Apache-2.0
#include <burnish/eval/sampler_expression.h>

namespace burnish {

namespace {

/// An expression of an integer.
struct ExprInt {
  Expr value;

  ExprInt() = default;
  explicit ExprInt(int x) : value(Expr::integer(x)) {}
  explicit ExprInt(Expr x) : value(std::move(x)) {}
};
ExprInt operator+(const ExprInt& a, const ExprInt& b) {
  return ExprInt(a.value + b.value);
}
ExprInt operator*(const ExprInt& a, const ExprInt& b) {
  return ExprInt(a.value * b.value);
}
ExprInt min(const ExprInt& a, const ExprInt& b) {
  return ExprInt(min(a.value, b.value));
}
ExprInt max(const ExprInt& a, const ExprInt& b) {
  return ExprInt(max(a.value, b.value));
}

/// a <= b
struct ExprMask {
  Expr a, b;
};
ExprMask less_or_equal(const Expr& a, const Expr& b) {
  return {a, b};
}
Expr if_true(const ExprMask& mask, const Expr& yes, const Expr& no) {
  return if_less(mask.b, mask.a, no, yes);
}
ExprInt if_true(const ExprMask& mask, const ExprInt& yes, const ExprInt& no) {
  return ExprInt(if_true(mask, yes.value, no.value));
}
Expr copy_sign(const Expr& size, const Expr& sign) {
  return if_less(sign, 0.0, -abs(size), abs(size));
}
ExprInt to_int(const Expr& x) {
  return ExprInt(Expr(Op::to_integer, {x}));
}
Expr to_real(const ExprInt& x) {
  return {Op::to_real, {x.value}};
}
ExprInt next_around(const ExprInt& i, int last) {
  return ExprInt(if_less(i.value, Expr::integer(last), i.value + Expr::integer(1), Expr::integer(0)));
}

Expr element(const char* table, const ExprInt& i) {
  return Expr::element(table, i.value, ValueType::integer);
}
struct ExprEdges {
  ExprInt lower, mass;
};
ExprEdges edge_pair(const char* table, const ExprInt& i) {
  const Expr lower = element(table, i), upper = element(table, i + ExprInt(1));
  const Expr mass = upper - lower;  // modulo 65536
  return {ExprInt(lower), ExprInt(if_less(upper, lower, mass + Expr::integer(65536), mass))};
}
// Searches by halves.
template <int kSlices>
ExprInt search(const char* table, const ExprInt (&start)[kSlices], const Expr (&weight)[kSlices], int count,
               const Expr& target) {
  ExprInt index(0);
  for (int step = count / 2; step > 0; step /= 2) {
    const ExprInt next = index + ExprInt(step);
    Expr edge;
    for (int s = 0; s < kSlices; ++s)
      edge = edge + weight[s] * to_real(ExprInt(element(table, start[s] + next)));
    index = if_true(less_or_equal(edge, target), next, index);
  }
  return index;
}

#define SAMPLER_INLINE inline
#include <burnish/eval/visible_half-inl.h>
#undef SAMPLER_INLINE

// The tables and numbers that the formulas read.
struct View : SamplerTables {
  double last_ring, turn_per_row, per_column, cells;
  const char *row_edges = "row_edges", *cell_edges = "cell_edges";

  explicit View(const SamplerTables& tables)
      : SamplerTables(tables),
        last_ring(tables.thetas - 1),
        turn_per_row((tables.isotropic ? 2.0 : 4.0) / tables.rows),
        per_column(1.0 / tables.columns),
        cells(cells_per_unit(tables.rows, tables.columns)) {}
};

}  // namespace

DrawnExpr sample_expression(const SamplerTables& tables) {
  const auto in = [](const char* name) { return Expr::input(name); };
  const auto drawn = [&](auto isotropic) {
    return draw<isotropic.value, Expr, ExprInt>(View(tables), in("wo_x"), in("wo_y"), in("wo_z"), in("u_x"),
                                                in("u_y"));
  };
  const Drawn<Expr> wi = tables.isotropic ? drawn(std::true_type()) : drawn(std::false_type());
  return {wi.x, wi.y, wi.z, wi.pdf};
}

Expr pdf_expression(const SamplerTables& tables) {
  const auto in = [](const char* name) { return Expr::input(name); };
  const auto found = [&](auto isotropic) {
    return density<isotropic.value, Expr, ExprInt>(View(tables), in("wi_x"), in("wi_y"), in("wi_z"),
                                                   in("wo_x"), in("wo_y"), in("wo_z"));
  };
  return tables.isotropic ? found(std::true_type()) : found(std::false_type());
}

}  // namespace burnish
