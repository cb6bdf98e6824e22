// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace burnish {

/// Returns how many letters have to be put in, left out, replaced or exchanged with their neighbour to make one word
/// of the other. Source: [Damerau 1964], with no letter changed twice.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that was meant by a misspelt word: the one of least edit_distance, the first of several, where that is at
/// most a third of the word's letters and at least one; else empty.
std::string_view closest_name(std::string_view word, std::span<const std::string_view> names);

/// "; did you mean 'NAME'?" of that name, or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

/// "expected one of A, B, found 'WORD'; did you mean 'A'?", what an Error says of a word that is none of the names.
std::string expected_one_of(std::span<const std::string_view> names, std::string_view word);

/// Names in a sentence, two or more: "A, B or C". `last_by` stands before the last one.
std::string listed(std::span<const std::string_view> names, std::string_view last_by = "or");

}  // namespace burnish
