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
// Integers that formulas use again have names, since text writes an integer without a name anew each time.
ExprInt max(const ExprInt& a, const ExprInt& b) {
  return ExprInt(named("whole", max(a.value, b.value)));
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
  return ExprInt(named("chosen", if_true(mask, yes.value, no.value)));
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
  return ExprInt(
      named("next", if_less(i.value, Expr::integer(last), i.value + Expr::integer(1), Expr::integer(0))));
}

// A whole number that is computed as a real one, as texels are.
struct WholeReal {
  Expr value;
};
Expr to_real(const WholeReal& x) {
  return x.value;
}

// One of a sampler's two tables: an array, or a texture from a row on.
struct Edges {
  std::string name;
  bool texture;
  int first_row;
};
// Returns an entry of a table: an integer of an array, a real number of a texture.
Expr element(const Edges& table, const ExprInt& i) {
  if (!table.texture) return Expr::element(table.name, i.value, ValueType::integer);
  const Expr width = Expr::integer(kSamplerTextureWidth), at = named("at", i.value),
             row = named("row", at / width);
  return Expr::texel(table.name, {at - row * width, row + Expr::integer(table.first_row)}, ValueType::real);
}
Expr real_element(const Edges& table, const ExprInt& i) {
  return table.texture ? element(table, i) : to_real(ExprInt(element(table, i)));
}
struct ExprEdges {
  WholeReal lower, mass;
};
ExprEdges edge_pair(const Edges& table, const ExprInt& i) {
  const Expr lower = named("lower", real_element(table, i)),
             upper = named("upper", real_element(table, i + ExprInt(1)));
  const Expr mass = upper - lower;  // modulo 65536
  return {{lower}, {if_less(upper, lower, mass + 65536.0, mass)}};
}
// Searches by halves.
template <int kSlices>
ExprInt search(const Edges& table, const ExprInt (&start)[kSlices], const Expr (&weight)[kSlices], int count,
               const Expr& target) {
  ExprInt index(0);
  for (int step = count / 2; step > 0; step /= 2) {
    const ExprInt next = index + ExprInt(step);
    Expr edge;
    for (int s = 0; s < kSlices; ++s) edge = edge + weight[s] * real_element(table, start[s] + next);
    index = ExprInt(named("index", if_true(less_or_equal(edge, target), next, index).value));
  }
  return index;
}

#define SAMPLER_INLINE inline
#include <burnish/eval/visible_half-inl.h>
#undef SAMPLER_INLINE

// The tables and numbers that the formulas read.
struct View : SamplerTables {
  double last_ring, turn_per_row, per_column, cells;
  Edges row_edges, cell_edges;

  View(const SamplerTables& tables, const SamplerArrays& arrays)
      : SamplerTables(tables),
        last_ring(tables.thetas - 1),
        turn_per_row((tables.isotropic ? 2.0 : 4.0) / tables.rows),
        per_column(1.0 / tables.columns),
        cells(cells_per_unit(tables.rows, tables.columns)) {
    const bool texture = !arrays.texture.empty();
    const int texture_rows =
        (static_cast<int>(tables.row_edges.size()) + kSamplerTextureWidth - 1) / kSamplerTextureWidth;
    row_edges = {texture ? arrays.texture : arrays.row_edges, texture, 0};
    cell_edges = {texture ? arrays.texture : arrays.cell_edges, texture, texture_rows};
  }
};

ExprVector numbers(const std::string& vector) {
  return {Expr::input(vector + "_x"), Expr::input(vector + "_y"), Expr::input(vector + "_z")};
}

}  // namespace

DrawnExpr sample_expression(const SamplerTables& tables, const ExprVector& wo, const ExprVector& u,
                            const SamplerArrays& arrays) {
  const auto drawn = [&](auto isotropic) {
    return draw<isotropic.value, Expr, ExprInt>(View(tables, arrays), wo.x, wo.y, wo.z, u.x, u.y);
  };
  const Drawn<Expr> wi = tables.isotropic ? drawn(std::true_type()) : drawn(std::false_type());
  return {wi.x, wi.y, wi.z, wi.pdf};
}

DrawnExpr sample_expression(const SamplerTables& tables) {
  return sample_expression(tables, numbers("wo"), numbers("u"));
}

Expr pdf_expression(const SamplerTables& tables, const ExprVector& wi, const ExprVector& wo,
                    const SamplerArrays& arrays) {
  const auto found = [&](auto isotropic) {
    return density<isotropic.value, Expr, ExprInt>(View(tables, arrays), wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
  };
  return tables.isotropic ? found(std::true_type()) : found(std::false_type());
}

Expr pdf_expression(const SamplerTables& tables) {
  return pdf_expression(tables, numbers("wi"), numbers("wo"));
}

}  // namespace burnish
