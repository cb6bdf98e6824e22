// SPDX-License-Identifier: Apache-2.0
#pragma once

// Half floats by arithmetic: without the table that Imath's library holds, so that what includes this links nothing.
#ifndef IMATH_HALF_NO_LOOKUP_TABLE
#define IMATH_HALF_NO_LOOKUP_TABLE
#endif

#include <Imath/half.h>
