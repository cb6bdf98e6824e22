// SPDX-License-Identifier: Apache-2.0
#include "command_description.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace burnish::cli {
namespace {

/// An option or a positional argument.
struct Argument {
  std::vector<std::string> names;    ///< with their dashes; the name alone of a positional argument
  std::string value;                 ///< the kind of its value ("TEXT"); empty: a flag
  std::vector<std::string> choices;  ///< the values that it takes, where these are few
  std::string description;
  std::string standard;  ///< its default, or empty
  bool positional = false;
};

/// A verb, "fit" or "specular code". The program itself has an empty name.
struct Verb {
  std::string name;
  std::string description;
  std::string examples;
  std::vector<Argument> arguments;
  std::vector<Verb> verbs;
};

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(separator, start), text.size());
    parts.emplace_back(text.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

Argument argument_of(const CLI::Option& option) {
  Argument argument{
      .names = {}, .description = option.get_description(), .standard = option.get_default_str()};
  argument.positional = option.get_positional();
  for (const std::string& name : option.get_snames()) argument.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) argument.names.push_back("--" + name);
  if (argument.positional) argument.names = {option.get_name(true)};
  if (option.get_items_expected_max() == 0) return argument;
  // CLI11's type name holds the type and its constraint: "TEXT:{image,relative}", "INT:INT in [1 - 64]".
  const std::string type = option.get_type_name();
  argument.value = type.substr(0, type.find(':'));
  const std::size_t open = type.find(":{");
  if (open != std::string::npos && type.back() == '}')
    argument.choices = split(std::string_view(type).substr(open + 2, type.size() - open - 3), ',');
  return argument;
}

Verb verb_of(const CLI::App& app, const std::string& name) {
  Verb verb{.name = name, .description = app.get_description(), .examples = app.get_footer()};
  for (const CLI::Option* option : app.get_options()) verb.arguments.push_back(argument_of(*option));
  for (const CLI::App* below :
       app.get_subcommands([](const CLI::App* each) { return !each->get_group().empty(); }))
    if (below->get_name().empty())  // a group of options
      for (const CLI::Option* option : below->get_options()) verb.arguments.push_back(argument_of(*option));
    else
      verb.verbs.push_back(
          verb_of(*below, name.empty() ? below->get_name() : name + " " + below->get_name()));
  return verb;
}

// --- manual pages

/// Escapes a text so that roff prints it unchanged.
std::string roff(const std::string& text) {
  std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (!escaped.empty() && (escaped.front() == '.' || escaped.front() == '\'')) escaped.insert(0, "\\&");
  return replaced(replaced(escaped, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

std::string roff(const Argument& argument) {
  std::string names;
  for (const std::string& name : argument.names)
    names += (names.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", roff(name));
  const std::string value =
      argument.choices.empty() ? argument.value : fmt::format("{}", fmt::join(argument.choices, "|"));
  if (!value.empty() && !argument.positional) names += fmt::format(" \\fI{}\\fR", roff(value));
  const std::string standard =
      argument.standard.empty() ? "" : fmt::format(" (default: {})", argument.standard);
  return fmt::format(".TP\n{}\n{}\n", names, roff(argument.description + standard));
}

/// Returns the text below a verb's heading: its synopsis, its arguments, the verbs below it, its examples.
std::string body(const Verb& verb, std::string_view heading) {
  std::string synopsis = fmt::format("\\fBburnish {}\\fR [\\fIoptions\\fR]", roff(verb.name));
  for (const Argument& argument : verb.arguments)
    if (argument.positional) synopsis += fmt::format(" \\fI{}\\fR", roff(argument.names.front()));
  if (!verb.verbs.empty()) synopsis += " \\fIverb\\fR ...";
  std::string text = fmt::format(".{} SYNOPSIS\n{}\n.{} OPTIONS\n", heading, synopsis, heading);
  for (const Argument& argument : verb.arguments) text += roff(argument);
  for (const Verb& below : verb.verbs) {
    if (verb.name.empty()) break;  // each verb has a page of its own
    text += fmt::format(".SH {}\n{}.\n", roff("burnish " + below.name), roff(below.description));
    text += body(below, "SS");
  }
  if (!verb.examples.empty())
    text += fmt::format(".{} EXAMPLES\n.nf\n{}\n.fi\n", heading, roff(verb.examples));
  return text;
}

ManualPage page(const Verb& verb, std::string_view version, const std::string& see_also) {
  const std::string name = verb.name.empty() ? "burnish" : "burnish-" + verb.name;
  std::string text =
      fmt::format(".TH {} 1 \"\" \"burnish {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", roff(name),
                  version, roff(name), roff(replaced(verb.description, "burnish: ", "")));
  text += body(verb, "SH");
  if (verb.name.empty()) {
    text += ".SH VERBS\n";
    for (const Verb& below : verb.verbs)
      text += fmt::format(".TP\n.B {}\n{}\n", roff(below.name), roff(below.description));
  }
  text += fmt::format(
      ".SH EXIT STATUS\n"
      "0 success, 1 bad input, 2 a wrong command line.\n"
      ".SH SEE ALSO\n"
      "{}\n",
      see_also);
  return {name + ".1", text};
}

// --- completions

/// Returns the words that may follow a verb's name: its verbs and its options.
std::string words(const Verb& verb) {
  std::vector<std::string> all;
  const std::size_t levels = verb.name.empty() ? 0 : split(verb.name, ' ').size();
  for (const Verb& below : verb.verbs) all.push_back(split(below.name, ' ')[levels]);
  for (const Argument& argument : verb.arguments)
    if (!argument.positional) all.insert(all.end(), argument.names.begin(), argument.names.end());
  return fmt::format("{}", fmt::join(all, " "));
}

/// Returns the names as a pattern of `case`: "--loss" or "-o|--output".
std::string pattern(const Argument& argument) {
  return fmt::format("{}", fmt::join(argument.names, "|"));
}

std::string bash_cases(const Verb& verb) {
  std::string text = fmt::format("    '{}')\n      case $previous in\n", verb.name);
  for (const Argument& argument : verb.arguments) {
    if (argument.positional || argument.value.empty()) continue;
    const std::string reply = argument.choices.empty() ? "compgen -f -- \"$word\""
                                                       : fmt::format("compgen -W '{}' -- \"$word\"",
                                                                     fmt::join(argument.choices, " "));
    text += fmt::format("        {}) mapfile -t COMPREPLY < <({}); return ;;\n", pattern(argument), reply);
  }
  text += fmt::format("      esac\n      words='{}' ;;\n", words(verb));
  for (const Verb& below : verb.verbs) text += bash_cases(below);
  return text;
}

/// Returns the names of verbs that have verbs below them, as patterns of `case`.
std::string branching(const Verb& verb) {
  std::string names = fmt::format("'{}'", verb.name);
  for (const Verb& below : verb.verbs)
    if (!below.verbs.empty()) names += "|" + branching(below);
  return names;
}

/// Escapes a text for the single quotes and the brackets of an argument of _arguments.
std::string zsh(std::string text) {
  for (const auto& [what, with] :
       {std::pair{"\\", "\\\\"}, {"'", "'\\''"}, {"[", "\\["}, {"]", "\\]"}, {":", "\\:"}})
    text = replaced(text, what, with);
  return replaced(text, "\n", " ");
}

std::string zsh_argument(const Argument& argument) {
  const std::string values =
      argument.choices.empty() ? "_files" : fmt::format("({})", fmt::join(argument.choices, " "));
  if (argument.positional) return fmt::format("'*:{}:_files'", zsh(argument.names.front()));
  const std::string value = argument.value.empty() ? "" : fmt::format(":{}:{}", zsh(argument.value), values);
  std::string text;
  for (const std::string& name : argument.names)
    text += fmt::format("{}'{}[{}]{}'", text.empty() ? "" : " ", name, zsh(argument.description), value);
  return text;
}

/// Returns a zsh function that completes the words after the verb's name, and the functions of the verbs below it.
std::string zsh_functions(const Verb& verb) {
  const auto function = [](const Verb& each) {
    return "_burnish" + (each.name.empty() ? "" : "_" + replaced(each.name, " ", "_"));
  };
  const std::string name = function(verb);
  std::string text = name + "() {\n  local state line\n  _arguments -C";
  for (const Argument& argument : verb.arguments) text += " \\\n    " + zsh_argument(argument);
  if (verb.verbs.empty()) {
    text += "\n}\n\n";
  } else {
    text +=
        " \\\n    '1:verb:->verb' '*::argument:->rest'\n  case $state in\n    verb)\n      local -a verbs=(";
    for (const Verb& below : verb.verbs)
      text += fmt::format("\n        '{}:{}'", split(below.name, ' ').back(), zsh(below.description));
    text += ")\n      _describe verb verbs ;;\n    rest)\n      case $line[1] in\n";
    for (const Verb& below : verb.verbs)
      text += fmt::format("        {}) {} ;;\n", split(below.name, ' ').back(), function(below));
    text += "      esac ;;\n  esac\n}\n\n";
  }
  for (const Verb& below : verb.verbs) text += zsh_functions(below);
  return text;
}

// --- JSON

nlohmann::ordered_json json_of(const Verb& verb) {
  nlohmann::ordered_json json{
      {"name", verb.name}, {"description", verb.description}, {"examples", verb.examples}};
  json["arguments"] = nlohmann::ordered_json::array();
  for (const Argument& argument : verb.arguments)
    json["arguments"].push_back({{"names", argument.names},
                                 {"value", argument.value},
                                 {"choices", argument.choices},
                                 {"default", argument.standard},
                                 {"description", argument.description},
                                 {"positional", argument.positional}});
  json["verbs"] = nlohmann::ordered_json::array();
  for (const Verb& below : verb.verbs) json["verbs"].push_back(json_of(below));
  return json;
}

}  // namespace

nlohmann::ordered_json description_json(const CLI::App& app) {
  std::string name;
  for (const CLI::App* verb = &app; verb->get_parent(); verb = verb->get_parent())
    name = verb->get_name() + (name.empty() ? "" : " " + name);
  return json_of(verb_of(app, name));
}

std::vector<ManualPage> manual_pages(const CLI::App& app, std::string_view version) {
  const Verb program = verb_of(app, "");
  std::string verbs;
  for (const Verb& verb : program.verbs)
    verbs += fmt::format("{}\\fBburnish\\-{}\\fR(1)", verbs.empty() ? "" : ", ", roff(verb.name));
  std::vector<ManualPage> pages = {page(program, version, verbs)};
  for (const Verb& verb : program.verbs) pages.push_back(page(verb, version, "\\fBburnish\\fR(1)"));
  return pages;
}

std::string bash_completion(const CLI::App& app) {
  const Verb program = verb_of(app, "");
  return fmt::format(
      R"(# bash completion of burnish, made by `burnish describe --bash`.
_burnish() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} verb='' words='' each
  COMPREPLY=()
  # the verb: the first words that are no options, as many as there are verbs below one another
  for each in "${{COMP_WORDS[@]:1:COMP_CWORD - 1}}"; do
    case $verb in
      {}) [[ $each == -* ]] || verb="${{verb:+$verb }}$each" ;;
      *) break ;;
    esac
  done
  case $verb in
{}  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  [[ $word == -* ]] || mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -f -- "$word")
}}
complete -o filenames -F _burnish burnish
)",
      branching(program), bash_cases(program));
}

std::string zsh_completion(const CLI::App& app) {
  return fmt::format(
      "#compdef burnish\n# zsh completion of burnish, made by `burnish describe --zsh`.\n\n{}_burnish "
      "\"$@\"\n",
      zsh_functions(verb_of(app, "")));
}

}  // namespace burnish::cli
