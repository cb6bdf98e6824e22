#pragma once

#include <span>
#include <string>
#include <string_view>

#include "opened_brdf.h"

namespace burnish::python {

/// What `repr` says: one line, what it is, its name, and what tells it from another.
std::string text_of_source(const OpenedBrdf& opened);
std::string text_of_model(const OpenedModel& opened);
std::string text_of_baseline(const OpenedBaseline& opened);
std::string text_of_table(const Table& table);
std::string text_of_use(const FactorUse& use);
std::string text_of_lobe(const Lobe& lobe);

/// "1 channel", "3 channels".
std::string counted(std::size_t count, const char* noun);

/// Names in quotes as a sentence has them: "\"a\", \"b\" and \"c\"".
std::string quoted_names(std::span<const std::string_view> names, std::string_view last_by = "and");

/// A name in quotes, of a long one its beginning and its end.
std::string quoted(const std::string& name);

}  // namespace burnish::python
