// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

namespace burnish {

/// Held while LAPACK or BLAS work: builds of OpenBLAS without threads of their own need not bear calls from several.
std::mutex& lapack_mutex();

}  // namespace burnish
