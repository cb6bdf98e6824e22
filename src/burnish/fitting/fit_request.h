// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <burnish/fitting/fit.h>

namespace burnish {

/// The values that an option of a fit takes: true or false; a text; a list of texts; one of some names; a whole
/// number; a number; "auto" or a number of bytes, which may be a text such as "16K"; "auto" or a number; a part of
/// the nodes; a file.
enum class FitValue { flag, text, texts, choice, whole, number, bytes, smoothness, node_part, file };

/// A row of the table of fit options: all that the command line, Python, the page's package and the guide say of it.
struct FitOption {
  std::string_view name;  ///< in Python, and in the values of a FitRequest: "hold_out"
  FitValue takes = FitValue::text;
  std::string_view help;                        ///< one sentence
  std::string_view example;                     ///< a value, as a word of the command line; empty for a flag
  std::vector<std::string_view> choices = {};   ///< of FitValue::choice
  std::optional<double> least = {}, most = {};  ///< the range of a number
  bool above_least = false;                     ///< the least itself is outside the range
  std::string_view standard = {};               ///< the value that stands where none is given
  std::string_view left_out = {};               ///< what the library does where none is given, if it chooses
  std::string_view needs = {};                  ///< an option that must be given too
  std::vector<std::string_view> excludes =
      {};  ///< options that cannot be given too; said in one row of the two
  std::string_view word = {}, other_word = {};  ///< on the command line, where that is not "--" and the name
  bool in_pages = true;                         ///< whether the page's package has it
};

/// The table. Its order is that of help texts and of checks.
std::span<const FitOption> fit_option_table();

/// The row of that name. Precondition: there is one.
const FitOption& fit_option(std::string_view name);

/// Returns true if two options cannot be given together, whichever row says so.
bool excludes(const FitOption& one, const FitOption& other);

/// Whoever asks for a fit. Messages name options as that place spells them, and are equal otherwise.
enum class FitFront { command_line, python, page };

/// "--hold-out", "hold_out" or "holdOut".
std::string spelled(const FitOption& option, FitFront front);

/// A fit as it was asked for. Each value is one that its option takes, and all go together.
struct FitRequest {
  nlohmann::ordered_json
      values;  ///< by name, in the table's order; only what was given and is not the default
  std::shared_ptr<const MaterialBook> book = nullptr;  ///< whoever asks for one opens it
};

/// Reads the words of a command line, pairs of an option's name and its text. The text of a flag is not read: a flag
/// on the command line turns its default round. Throws Error for a value that an option does not take, and for options
/// that need or exclude others.
FitRequest request_of_words(std::span<const std::pair<std::string, std::string>> words,
                            FitFront front = FitFront::command_line);

/// Reads an object of values by name, as `front` spells the names. null is what is not given. Throws Error as
/// request_of_words does, and for a name that is no option.
FitRequest request_of_json(const nlohmann::ordered_json& object, FitFront front);

/// The options of the fit, without progress. A model is read for an isotropic source or for another one. Throws Error
/// as parse_model_spec does. Precondition: a request for a book holds the book.
FitOptions fit_options(const FitRequest& request, bool isotropic);

/// "from 1 to 256", "above 0 and at most 1"; empty for an option without a range.
std::string range_text(const FitOption& option);

/// The table as JSON, a list of rows with their names at each front, for `burnish describe --json` and the guide.
nlohmann::ordered_json fit_options_json();

}  // namespace burnish
