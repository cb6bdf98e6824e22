#pragma once

#include <burnish/power/power.h>

namespace burnish {

/// Counts the operations of the member's value, coefficients given, each shared term once.
PowerCost count_operations(PowerMethod method);

}  // namespace burnish
