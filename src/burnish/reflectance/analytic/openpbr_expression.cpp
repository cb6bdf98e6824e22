// SPDX-License-Identifier: Apache-2.0
#include <burnish/reflectance/analytic/openpbr-inl.h>
#include <burnish/reflectance/analytic/openpbr_expression.h>

namespace burnish {

Expr openpbr_expression(const OpenPbr& material) {
  const ExprVector wi(Expr::input("wi", ValueType::vector)), wo(Expr::input("wo", ValueType::vector));
  const OpenPbr::Geometry<Expr> g(wi, wo, material);
  OpenPbr::Parts<Expr> parts;
  material.compute(material.needed(), g, parts);
  const ExprColor value = material.join(parts);
  return {Op::vector, {value.r, value.g, value.b}};
}

}  // namespace burnish
