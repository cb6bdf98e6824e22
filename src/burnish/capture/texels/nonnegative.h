#pragma once

#include <span>

namespace burnish {

/// The w >= 0 with the least w^T A w / 2 - b^T w, A symmetric and positive definite, by the active-set method of
/// Lawson and Hanson on the normal equations [LawsonHanson1974]. A row by row, of b.size() unknowns, at most
/// kMaxSurfaceLobes. Begins at 0, or where `near` at the w given, finite and >= 0, which ends soonest where the same
/// unknowns stay 0. Ends after 3 unknowns changes of the active set at most. What is not finite gives zeros.
void solve_nonnegative(std::span<const double> a, std::span<const double> b, std::span<double> w,
                       bool near = false) noexcept;

}  // namespace burnish
