// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "opened_brdf.h"

namespace burnish::python {

/// Return the text of `repr`: one line with the kind of object, its name, and its distinguishing properties.
std::string text_of_source(const OpenedBrdf& opened);
std::string text_of_model(const OpenedModel& opened);
std::string text_of_baseline(const OpenedBaseline& opened);
std::string text_of_table(const Table& table);
std::string text_of_use(const FactorUse& use);
std::string text_of_lobe(const Lobe& lobe);

/// Returns a count with its noun: "1 channel", "3 channels".
std::string counted(std::size_t count, const char* noun);

/// Returns names in quotes, joined for a sentence: "\"a\", \"b\" and \"c\"".
std::string quoted_names(std::span<const std::string_view> names, std::string_view last_by = "and");

/// Returns a name in quotes; of a long one it has the beginning and the end.
std::string quoted(const std::string& name);

}  // namespace burnish::python
