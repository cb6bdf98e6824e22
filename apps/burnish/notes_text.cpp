// SPDX-License-Identifier: Apache-2.0
#include "notes_text.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/io/text_reader.h>

namespace burnish::cli {

namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::pair<std::string, std::string>>;

std::string number_text(double x) {
  return x == 0 || std::abs(x) >= 1e-3 ? fmt::format("{:.4g}", x) : fmt::format("{:.1e}", x);
}

// Turns a name of the JSON into words: "node_expected" becomes "node expected".
std::string in_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

// Formats any value on one line: members as "name value", lists with blanks.
std::string plain_text(const Json& value) {
  if (value.is_string()) return printable(value.get<std::string>(), 200);
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  if (value.is_number()) return number_text(value.get<double>());
  if (value.is_null()) return "none";
  std::string text;
  for (const auto& [name, member] : value.items()) {
    const std::string said =
        member.is_structured() ? fmt::format("({})", plain_text(member)) : plain_text(member);
    text += text.empty() ? "" : value.is_object() ? ", " : " ";
    text += value.is_object() ? in_words(name) + ' ' + said : said;
  }
  return text;
}

/// Takes each known part of the notes once, and prints the other parts as they stand.
class Notes {
 public:
  explicit Notes(Json json) : json_(std::move(json)) {}

  Lines lines() {
    fit();
    bytes();
    errors();
    nodes();
    for (const auto& [name, value] : json_.items())
      if (!value.empty()) add(in_words(name), plain_text(value));
    return std::move(lines_);
  }

 private:
  std::string take(const std::string& name) {
    const auto found = json_.find(name);
    if (found == json_.end()) return "";
    std::string text = plain_text(*found);
    json_.erase(found);
    return text;
  }
  // Joins the values of the names that exist, each followed by its unit: "samples 500, seed 3".
  std::string take_all(std::initializer_list<std::pair<const char*, const char*>> names) {
    std::string text;
    for (const auto& [name, unit] : names)
      if (const std::string value = take(name); !value.empty())
        text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", in_words(name), value, unit);
    return text;
  }
  void add(const std::string& word, const std::string& says) {
    if (!says.empty()) lines_.emplace_back(word, says);
  }

  void fit() {
    const std::string source = take("source"), format = take("source_format");
    if (!source.empty()) add("fitted to", source + (format.empty() ? "" : fmt::format(" ({})", format)));
    std::string how;
    const auto more = [&](const std::string& text) {
      if (!text.empty()) how += (how.empty() ? "" : ", ") + text;
    };
    if (const std::string samples = take("samples"); !samples.empty()) more(samples + " samples");
    if (const std::string lobes = take("lobes"); !lobes.empty())
      more(lobes + (lobes == "1" ? " lobe" : " lobes"));
    const std::string steps = take("iterations"), reason = take("stop_reason");
    if (!steps.empty())
      more(steps + " steps" + (reason.empty() ? "" : fmt::format(" ({})", ending_text(reason))));
    more(take_all({{"loss", ""}, {"smooth", ""}, {"floor", ""}, {"reweightings", ""}}));
    add("by", how);
    if (const std::string symmetrized = take("symmetrized"); symmetrized == "yes")
      add("made", "reciprocal: values of exchanged directions were averaged first");
    take("objective");  // serves the solver alone
    for (const char* said_before : {"part", "band"}) take(said_before);
  }

  void bytes() {
    const std::string budget = take("budget"), fetches = take("fetches");
    if (!budget.empty() || !fetches.empty())
      add("within",
          (budget.empty() ? "" : budget + " bytes") +
              (fetches.empty() ? "" : fmt::format("{}{} fetches", budget.empty() ? "" : ", ", fetches)));
    trials("fetch_trials", "fetches", "tried");
    const auto choice = json_.find("budget_choice");
    if (choice == json_.end() || !choice->is_object()) return;
    const auto stop = choice->find("stop");
    if (stop != choice->end())
      add("bytes by", "--budget auto, which stopped at " + stop_text(plain_text(*stop)));
    if (const auto noise = choice->find("noise"); noise != choice->end())
      add("itself", "the error of the measurement is " + plain_text(*noise));
    if (const auto tried = choice->find("trials"); tried != choice->end() && tried->is_array())
      for (const Json& trial : *tried) add("tried", plain_text(trial));
    json_.erase("budget_choice");
  }

  static std::string stop_text(const std::string& stop) {
    if (stop == "noise") return "the measurement's own noise";
    if (stop == "floor") return "an error that is small enough";
    if (stop == "gain") return "little gain";
    if (stop == "largest") return "the largest budget that is tried";
    if (stop == "cross-validation") return "the best prediction of held-out samples";
    return stop;
  }

  void trials(const char* name, const char* what, const char* word) {
    const auto found = json_.find(name);
    if (found == json_.end() || !found->is_array()) return;
    std::string text;
    for (const Json& trial : *found)
      if (trial.is_object() && trial.contains(what) && trial.contains("error"))
        text += fmt::format("{}{} (error {})", text.empty() ? "" : ", ", plain_text(trial[what]),
                            plain_text(trial["error"]));
    add(word, text.empty() ? text : fmt::format("{} {}", what, text));
    json_.erase(found);
  }

  void errors() {
    add("held out",
        take_all({{"psnr", " dB"}, {"ssim", ""}, {"relative", ""}, {"rms_log", ""}, {"log_cos", ""}}));
  }

  void nodes() {
    const std::string target = take("target"), count = take("nodes");
    if (!count.empty())
      add("target", target == "nodes" ? count + " measured nodes" : target + ", " + count + " nodes");
    else
      add("target", target);
    if (const std::string left_out = take("outliers"); !left_out.empty())
      add("outliers", left_out + " samples left out");
    figures("node_fit", "nodes", "the fitted nodes");
    figures("node_test", "left out", "the nodes left out");
    figures("node_held_out", "unseen", "each node, predicted by the other nodes");
    if (const auto found = json_.find("node_expected"); found != json_.end() && found->is_object()) {
      std::string text = found->contains("relative") ? "relative " + plain_text((*found)["relative"]) : "";
      text += ", measured or not";
      std::string from, values;
      if (const auto bands = found->find("from_theta_i_deg"); bands != found->end() && bands->is_object())
        for (const auto& [theta_i, relative] : bands->items()) {
          from += ' ' + theta_i;
          values += ' ' + plain_text(relative);
        }
      if (!from.empty()) text += fmt::format(";{} from theta_i ={} degrees on", values, from);
      add("expected", text);
      json_.erase("node_expected");
    }
    if (const auto found = json_.find("node_covariance"); found != json_.end()) {
      add("kriged", plain_text(*found));
      json_.erase("node_covariance");
    }
  }

  void figures(const char* name, const char* word, const char* of) {
    const auto found = json_.find(name);
    if (found == json_.end() || !found->is_object()) return;
    std::string text;
    for (const auto& [figure, value] : found->items())
      if (figure != "count")
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", figure, plain_text(value));
    if (found->contains("count")) text += fmt::format(" at {} nodes", plain_text((*found)["count"]));
    add(word, fmt::format("{}: {}", of, text));
    json_.erase(found);
  }

  Json json_;
  Lines lines_;
};

}  // namespace

Lines notes_lines(const std::string& notes) {
  const Json json = Json::parse(notes, nullptr, false);
  if (!json.is_object()) return {{"notes", printable(notes, 200)}};
  return Notes(json).lines();
}

std::string ending_text(const std::string& reason) {
  if (reason == "iteration limit") return "all that were planned";
  return reason;
}

}  // namespace burnish::cli
