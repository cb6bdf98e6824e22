// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

namespace burnish {

/// The result of preconditioned_cg. Residuals are r^T M^-1 r, M being the preconditioner.
struct CgResult {
  double first_residual = 0, residual = 0;
  int iterations = 0;
};

/// Solves A x = b for a symmetric positive definite A by preconditioned conjugate gradients [Hestenes 1952] from
/// x = 0, which `x` holds. Ends where the residual is at most tolerance^2 times the first or no number, and after
/// max_iterations. `apply(v)` is A v, `precondition(r)` is M^-1 r, `dot` an inner product; after_step(result) is
/// called after each iteration.
template <class Vector, class Apply, class Precondition, class Dot, class AfterStep>
CgResult preconditioned_cg(Vector& x, Vector b, double tolerance, int max_iterations, const Apply& apply,
                           const Precondition& precondition, const Dot& dot, const AfterStep& after_step) {
  using Index = decltype(x.size());
  Vector r = std::move(b), z = precondition(r), p = z;
  CgResult result;
  result.first_residual = result.residual = dot(r, z);
  const double enough = tolerance * tolerance * result.first_residual;
  while (result.iterations < max_iterations && result.residual > enough) {
    // A step along the direction p goes to the least of the quadratic form.
    const Vector ap = apply(p);
    const double alpha = result.residual / dot(p, ap);
    for (Index i = 0; i < x.size(); ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * ap[i];
    }
    // The next direction is conjugate to all before.
    z = precondition(r);
    const double next = dot(r, z), beta = next / result.residual;
    for (Index i = 0; i < p.size(); ++i) p[i] = z[i] + beta * p[i];
    result.residual = next;
    ++result.iterations;
    after_step(result);
  }
  return result;
}

}  // namespace burnish
