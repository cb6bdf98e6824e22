// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace burnish {

/// Finds the w >= 0 with the least w^T A w / 2 - b^T w, where A is symmetric and positive definite. The method is the
/// active-set method of Lawson and Hanson on the normal equations [LawsonHanson1974]. `a` holds A row by row; the
/// unknowns are b.size(), at most kMaxSurfaceLobes. The search begins at 0, or with `near` at the given w, which is
/// finite and >= 0. The latter is fastest if the same unknowns stay 0. It ends after at most 3 b.size() changes of
/// the active set. Values that are not finite give zeros.
void solve_nonnegative(std::span<const double> a, std::span<const double> b, std::span<double> w,
                       bool near = false) noexcept;

}  // namespace burnish
