// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <burnish/error.h>

namespace burnish {

/// The member of a JSON object that is a whole number from `least` to `most`: the JSON library's own conversion is
/// undefined for numbers that an int cannot hold. Throws Error for another number, the library's error for what is
/// none.
template <class Json>
int integer_at(const Json& object, const char* key, int least = 0,
               int most = std::numeric_limits<int>::max()) {
  const auto number = object.at(key).template get<double>();
  if (!(number >= least && number <= most) || number != std::floor(number))
    throw Error(fmt::format("expected {} of {} to {}, found {}", key, least, most, number));
  return static_cast<int>(number);
}

}  // namespace burnish
