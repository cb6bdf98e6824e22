// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/power/choose.h>
#include <burnish/power/code.h>

#include "json_output.h"
#include "specular_command.h"
#include "usage.h"

namespace burnish::cli {
namespace {

double parse_number(const std::string& text, const char* what) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !std::isfinite(value))
    throw Error(fmt::format("{}: expected a number, found '{}'", what, text));
  return value;
}

/// Parses "0.01" or "1/255".
double parse_fraction(const std::string& text, const char* what) {
  const auto slash = text.find('/');
  if (slash == std::string::npos) return parse_number(text, what);
  const double below = parse_number(text.substr(slash + 1), what);
  if (below == 0) throw Error(fmt::format("{}: expected a fraction, found '{}'", what, text));
  return parse_number(text.substr(0, slash), what) / below;
}

nlohmann::json cost_json(const PowerCost& cost) {
  return {
      {"multiplies", cost.multiplies},   {"adds", cost.adds},      {"compares", cost.compares},
      {"divisions", cost.divisions},     {"roots", cost.roots},    {"transcendentals", cost.transcendentals},
      {"table_words", cost.table_words}, {"weight", cost.weight()}};
}

}  // namespace

void add_specular_list(CLI::App& verb) {
  CLI::App* sub = verb.add_subcommand("list", "List the approximations: cost, proved bounds, formula");
  sub->footer("Example: burnish specular list --json");
  auto json = std::make_shared<bool>(false);
  sub->add_flag("--json", *json, "Prints the same as JSON.");
  sub->callback([json] {
    if (*json) {
      nlohmann::json list = nlohmann::json::array();
      for (const PowerInfo& info : power_methods()) {
        nlohmann::json bounds = nlohmann::json::array();
        for (const PowerBound& b : info.bounds)
          bounds.push_back(
              {{"min_exponent", b.min_exponent}, {"max_exponent", b.max_exponent}, {"bound", b.bound}});
        list.push_back(
            {{"name", info.name},
             {"formula", info.formula},
             {"source", info.source},
             {"cost", cost_json(info.cost)},
             {"bounds", bounds},
             {"monotone_from", info.monotone_from ? nlohmann::json(*info.monotone_from) : nullptr}});
      }
      fmt::print("{}\n", list.dump(2));
      return;
    }
    fmt::print("{:<16} {:>4} {:>4} {:>4} {:>4} {:>5} {:>6}  {:<40} {}\n", "name", "mul", "add", "cmp", "div",
               "trans", "words", "proved error from exponent", "formula, u = 1 - c");
    for (const PowerInfo& info : power_methods()) {
      std::string bounds;
      for (const PowerBound& b : info.bounds)
        bounds += fmt::format("{}{:.3g} from {:g}", bounds.empty() ? "" : ", ", b.bound, b.min_exponent);
      fmt::print("{:<16} {:>4} {:>4} {:>4} {:>4} {:>5} {:>6}  {:<40} {}\n", info.name, info.cost.multiplies,
                 info.cost.adds, info.cost.compares, info.cost.divisions,
                 info.cost.transcendentals + info.cost.roots, info.cost.table_words, bounds, info.formula);
    }
  });
}

void add_specular_choose(CLI::App& verb) {
  struct Arguments {
    std::string max_error = "1/255", exponents = "1:1000", language = "c";
    bool json = false;
  };
  CLI::App* sub =
      verb.add_subcommand("choose", "Choose the approximation for a range of exponents, and write its code");
  sub->footer("Example: burnish specular choose --max-error 1/255 --exponents 1:1000");
  auto arguments = std::make_shared<Arguments>();
  sub->add_option("--max-error", arguments->max_error, "Allows this absolute error, a number or a fraction.")
      ->capture_default_str();
  sub->add_option("--exponents", arguments->exponents, "Chooses for these exponents, FIRST:LAST or one.")
      ->capture_default_str();
  const auto languages = code_languages();
  sub->add_option("--to,--lang", arguments->language, "Writes the code in this language.")
      ->check(one_of({languages.begin(), languages.end()}))
      ->capture_default_str();
  sub->add_flag("--json", arguments->json, "Prints the same as JSON.");
  sub->callback([arguments] {
    // The range is FIRST:LAST, or one exponent, for which the code has constants.
    const std::string& range = arguments->exponents;
    const auto colon = range.find(':');
    const auto number = [](const std::string& text) {
      return usage([&] { return parse_number(text, "--exponents"); });
    };
    const double first = number(range.substr(0, colon));
    const double last = colon == std::string::npos ? first : number(range.substr(colon + 1));
    const auto choices =
        usage([&] { return choose_power(parse_fraction(arguments->max_error, "--max-error"), first, last); });
    const CodeOptions options{arguments->language, first == last ? std::optional(first) : std::nullopt,
                              false};
    const auto code = [&](PowerMethod method) { return usage([&] { return power_code(method, options); }); };
    if (arguments->json) {
      nlohmann::json list = nlohmann::json::array();
      for (const PowerChoice& choice : choices)
        list.push_back({{"min_exponent", choice.min_exponent},
                        {"max_exponent", choice.max_exponent},
                        {"method", power_info(choice.method).name},
                        {"bound", choice.bound},
                        {"weight", power_info(choice.method).cost.weight()},
                        {"code", code(choice.method)}});
      fmt::print("{}\n", list.dump(2));
      return;
    }
    for (const PowerChoice& choice : choices)
      fmt::print("// exponents {:g} to {:g}: {}, error at most {:g}, cost {}\n", choice.min_exponent,
                 choice.max_exponent, power_info(choice.method).name, choice.bound,
                 power_info(choice.method).cost.weight());
    // Several ranges may use one method, whose code is printed once.
    std::vector<PowerMethod> written;
    for (const PowerChoice& choice : choices) {
      if (std::find(written.begin(), written.end(), choice.method) != written.end()) continue;
      written.push_back(choice.method);
      fmt::print("\n{}", code(choice.method));
    }
  });
}

void add_specular_code(CLI::App& verb) {
  struct Arguments {
    std::string method = "cubic2", language = "c";
    TextOutput to;
    std::optional<double> exponent;
    bool normalize = false;
  };
  CLI::App* sub = verb.add_subcommand("code", "Write a member as a function in another language");
  sub->footer("Example: burnish specular code --method cubic2 --to glsl --exponent 50");
  auto arguments = std::make_shared<Arguments>();
  std::string languages;
  for (const auto name : code_languages()) languages += (languages.empty() ? "" : ", ") + std::string(name);
  sub->add_option("--method", arguments->method, "Takes this method of `specular list`.")
      ->capture_default_str();
  sub->add_option("--to,--lang", arguments->language, "Writes the code in this language: " + languages + ".")
      ->capture_default_str();
  sub->add_option("--exponent", arguments->exponent,
                  "Writes constants for this exponent, which is otherwise an argument.");
  sub->add_flag("--normalize", arguments->normalize, "Keeps the energy of the power; needs --exponent.");
  add_text_output(*sub, arguments->to);
  sub->callback([arguments] {
    const std::string code = usage([&] {
      return power_code(power_method(arguments->method),
                        {arguments->language, arguments->exponent, arguments->normalize});
    });
    nlohmann::ordered_json about{{"method", arguments->method}, {"language", arguments->language}};
    if (arguments->exponent) about["exponent"] = *arguments->exponent;
    about["normalized"] = arguments->normalize;
    about["cost"] = cost_json(power_info(power_method(arguments->method)).cost);
    write_text(arguments->to, "code", code, about);
  });
}

void add_specular_eval(CLI::App& verb) {
  struct Arguments {
    std::string method = "exact";
    double exponent = 1;
    bool normalize = false, json = false;
  };
  CLI::App* sub =
      verb.add_subcommand("eval", "Evaluate an approximation for cosines from standard input, one a line");
  sub->footer("Example: printf '1\\n0.9\\n' | burnish specular eval --method cubic2 --exponent 50");
  auto arguments = std::make_shared<Arguments>();
  sub->add_option("--method", arguments->method, "Takes this method of `specular list`.")->required();
  sub->add_option("--exponent", arguments->exponent, "Raises to this exponent.")->required();
  sub->add_flag("--normalize", arguments->normalize, "Keeps the energy of the power.");
  sub->add_flag("--json", arguments->json, "Prints cosines and values as JSON.");
  sub->callback([arguments] {
    auto list = nlohmann::ordered_json::array();
    const PowerCoefficients k =
        usage([&] { return power_coefficients(power_method(arguments->method), arguments->exponent); });
    const double scale = arguments->normalize ? power_normalization(k.method, arguments->exponent) : 1;
    std::string line;
    for (std::uint64_t number = 1; std::getline(std::cin, line); ++number) {
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      double cosine = -1;
      try {
        cosine = parse_number(line, "cosine");
      } catch (const Error&) {
      }
      if (!(cosine >= 0 && cosine <= 1))
        throw Error::in_line("standard input", number, "a cosine in [0, 1]", "'" + line + "'");
      const double value = scale * power(k, cosine);
      if (arguments->json)
        list.push_back({{"cosine", cosine}, {"value", value}});
      else
        fmt::print("{:.17g}\n", value);
    }
    if (arguments->json) print_as_json(list);
  });
}

void add_specular_table(CLI::App& verb) {
  struct Arguments {
    std::string format = "csv";
    TextOutput to;
    int count = 1000, fraction_bits = 8;
  };
  CLI::App* sub = verb.add_subcommand("table", "Write the paper's coefficient a(e) for e = 1, 2, …");
  sub->footer("Example: burnish specular table --to mem --fraction-bits 8 -o quadratic_a.mem");
  auto arguments = std::make_shared<Arguments>();
  sub->add_option("--to,--format", arguments->format,
                  "Writes csv, a C header (c), or a PROM image for $readmemh (mem).")
      ->check(one_of({"csv", "c", "mem"}))
      ->capture_default_str();
  sub->add_option("--last,--count", arguments->count, "Ends at this exponent.")->capture_default_str();
  sub->add_option("--fraction-bits", arguments->fraction_bits,
                  "Gives the PROM's fixed point words this many fraction bits.")
      ->capture_default_str();
  add_text_output(*sub, arguments->to);
  sub->callback([arguments] {
    const std::string table =
        usage([&] { return quadratic_table(arguments->format, arguments->count, arguments->fraction_bits); });
    write_text(arguments->to, "table", table, {{"format", arguments->format}, {"count", arguments->count}});
  });
}

}  // namespace burnish::cli
