// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace burnish {

/// One line of at most `longest` bytes, by default 285, which leaves room below 300 for a program's name: without what is
/// blank at the end, control characters as blanks, of longer ones the beginning and the end with " ... " between, no
/// character of UTF-8 cut. The same again of what it gave. longest >= 200.
std::string short_message(std::string_view message, std::size_t longest = 285);

}  // namespace burnish
