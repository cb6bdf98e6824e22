// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/fitting/baselines/baselines.h>
#include <burnish/fitting/fit_request.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::pair<std::string, std::string>>;
using ::testing::HasSubstr;

/// One wrong request in two forms, and the error that it gets.
struct Wrong {
  Words words;
  const char* json;
  const char* said;
};

// Most of these requests were once accepted silently by the command line, Python or the page.
const std::vector<Wrong>& wrong_requests() {
  static const std::vector<Wrong> all{
      {{{"model", "pqp"}, {"budget", "2700"}},
       R"({"model": "pqp", "budget": 2700})",
       "budget excludes model"},
      {{{"fetches", "2"}}, R"({"fetches": 2})", "fetches requires budget"},
      {{{"lobes", "3"}, {"search", ""}}, R"({"lobes": 3, "search": true})", "lobes requires budget"},
      {{{"search", ""}}, R"({"search": true})", "search requires budget"},
      {{{"tables", "q=96"}, {"budget", "2700"}},
       R"({"tables": ["q=96"], "budget": 2700})",
       "budget excludes tables"},
      {{{"budget", "2700"}, {"fetches", "2"}, {"lobes", "3"}},
       R"({"budget": 2700, "fetches": 2, "lobes": 3})",
       "fetches excludes lobes"},
      {{{"budget", "16K"}, {"fetches", "2"}, {"search", ""}},
       R"({"budget": "16K", "fetches": 2, "search": true})",
       "fetches excludes search"},
      {{{"method", "svd"}, {"model", "pqp"}},
       R"({"method": "svd", "model": "pqp"})",
       "method excludes model"},
      {{{"method", "svd"}, {"budget", "auto"}},
       R"({"method": "svd", "budget": "auto"})",
       "budget: expected a number of bytes with method, found 'auto'"},
      {{{"method", "svd"}, {"budget", "400"}, {"fetches", "2"}},
       R"({"method": "svd", "budget": 400, "fetches": 2})",
       "method excludes fetches"},
      {{{"method", "svd"}, {"format", "half"}},
       R"({"method": "svd", "format": "half"})",
       "method excludes format"},
      {{{"method", "svd"}, {"loss", "relative"}},
       R"({"method": "svd", "loss": "relative"})",
       "method excludes loss"},
      {{{"method", "nd"}, {"smooth", "auto"}},
       R"({"method": "nd", "smooth": "auto"})",
       "method excludes smooth"},
      {{{"method", "nd"}, {"conserve_energy", ""}},
       R"({"method": "nd", "conserve_energy": true})",
       "method excludes conserve_energy"},
      {{{"book", "a.burnish"}, {"budget", "2700"}},
       R"({"book": "a.burnish", "budget": 2700})",
       "budget excludes book"},
      {{{"book", "a.burnish"}, {"model", "pqp"}},
       R"({"book": "a.burnish", "model": "pqp"})",
       "model excludes book"},
      {{{"book", "a.burnish"}, {"fetches", "2"}},
       R"({"book": "a.burnish", "fetches": 2})",
       "fetches requires budget"},
      {{{"book", "a.burnish"}, {"symmetrize", ""}},
       R"({"book": "a.burnish", "symmetrize": false})",
       "symmetrize=false excludes book"},
      {{{"book", "a.burnish"}, {"target", "nodes"}},
       R"({"book": "a.burnish", "target": "nodes"})",
       "target excludes book"},
      {{{"book", "a.burnish"}, {"method", "svd"}},
       R"({"book": "a.burnish", "method": "svd"})",
       "method excludes book"},
      {{{"target", "function"}, {"hold_out", "half=1"}},
       R"({"target": "function", "hold_out": "half=1"})",
       "target: expected nodes with hold_out, found 'function'"},
      // These have wrong values.
      {{{"budget", "much"}},
       R"({"budget": "much"})",
       "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found 'much'"},
      {{{"budget", "0"}},
       R"({"budget": 0})",
       "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found '0'"},
      {{{"budget", "-5"}},
       R"({"budget": -5})",
       "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found '-5'"},
      {{{"budget", "4G"}},
       R"({"budget": "4G"})",
       "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found '4G'"},
      {{{"budget", "2700.5"}},
       R"({"budget": 2700.5})",
       "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found '2700.5'"},
      {{{"budget", "16K"}, {"fetches", "0"}},
       R"({"budget": 16384, "fetches": 0})",
       "fetches: expected a whole number from 1 to 256, found '0'"},
      {{{"budget", "16K"}, {"fetches", "two"}},
       R"({"budget": 16384, "fetches": "two"})",
       "fetches: expected a whole number from 1 to 256, found 'two'"},
      {{{"budget", "16K"}, {"lobes", "1.5"}},
       R"({"budget": 16384, "lobes": 1.5})",
       "lobes: expected a whole number from 1 to 64, found '1.5'"},
      {{{"loss", "realtive"}},
       R"({"loss": "realtive"})",
       "loss: expected one of image, relative, log_cos, found 'realtive'; did you mean 'relative'?"},
      {{{"target", "cells"}},
       R"({"target": "cells"})",
       "target: expected one of function, nodes, found 'cells'"},
      {{{"hold_out", "half=2"}},
       R"({"hold_out": "half=2"})",
       "hold_out: expected half=0, half=1 or theta_i=K, found 'half=2'"},
      {{{"smooth", "much"}},
       R"({"smooth": "much"})",
       "smooth: expected auto or a number of at least 0, found 'much'"},
      {{{"smooth", "-1"}},
       R"({"smooth": -1})",
       "smooth: expected auto or a number of at least 0, found '-1'"},
      {{{"floor", "0"}}, R"({"floor": 0})", "floor: expected a number above 0 and at most 1, found '0'"},
      {{{"floor", "2"}}, R"({"floor": 2})", "floor: expected a number above 0 and at most 1, found '2'"},
      {{{"reweightings", "101"}},
       R"({"reweightings": 101})",
       "reweightings: expected a whole number from 0 to 100, found '101'"},
      {{{"samples", "0"}},
       R"({"samples": 0})",
       "samples: expected a whole number from 1 to 100000000, found '0'"},
      {{{"seed", "-1"}}, R"({"seed": -1})", "seed: expected a whole number of at least 0, found '-1'"},
      {{{"format", "double"}},
       R"({"format": "double"})",
       "format: expected one of half, float, rgb9e5, unorm8, found 'double'"},
      {{{"model", ""}}, R"({"model": ""})", "model: expected a text, found ''"},
  };
  return all;
}

std::string error_of_words(const Words& words, FitFront front) {
  return error_of([&] { request_of_words(words, front); });
}

TEST(FitRequest, RefusesTheSameInTheSameWordsEverywhere) {
  ASSERT_GE(wrong_requests().size(), 20u);
  for (const auto& [words, json, said] : wrong_requests()) {
    EXPECT_EQ(error_of([&, text = json] { request_of_json(Json::parse(text), FitFront::python); }), said);
    EXPECT_EQ(error_of_words(words, FitFront::python), said);
  }
}

TEST(FitRequest, SaysOnTheCommandLineTheSameOfOptionsWithDashes) {
  for (const auto& [words, json, said] : wrong_requests()) {
    std::string message = error_of_words(words, FitFront::command_line);
    for (const FitOption& option : fit_option_table()) {
      const std::string word = spelled(option, FitFront::command_line);
      const std::string name = std::string(option.name) + (option.name == "symmetrize" ? "=false" : "");
      for (std::size_t at = 0; (at = message.find(word, at)) != std::string::npos; at += name.size())
        message.replace(at, word.size(), name);
    }
    EXPECT_EQ(message, said);
  }
  EXPECT_EQ(error_of_words({{"model", "pqp"}, {"budget", "2700"}}, FitFront::command_line),
            "--budget excludes --model");
}

TEST(FitRequest, NamesOptionsAsAPageDoes) {
  const auto said = [](const char* json) {
    return error_of([&] { request_of_json(Json::parse(json), FitFront::page); });
  };
  EXPECT_EQ(said(R"({"holdOut": "half=1", "target": "function"})"),
            "target: expected nodes with holdOut, found 'function'");
  EXPECT_THAT(said(R"({"hold_out": "half=1"})"), HasSubstr("found 'hold_out'; did you mean 'holdOut'?"));
  EXPECT_THAT(said(R"({"method": "svd"})"), HasSubstr("found 'method'")) << "a page has no other methods";
  EXPECT_EQ(said("7"), "fit: expected options, found 7");
}

TEST(FitRequest, RefusesKindsThatNoWordCanHave) {
  const auto said = [](const char* json) {
    return error_of([&] { request_of_json(Json::parse(json), FitFront::python); });
  };
  EXPECT_EQ(said(R"({"symmetrize": 3})"), "symmetrize: expected true or false, found '3'");
  EXPECT_EQ(said(R"({"tables": "q=3"})"), "tables: expected a list of texts, found 'q=3'");
  EXPECT_EQ(said(R"({"tables": [3]})"), "tables: expected a list of texts, found '[3]'");
  EXPECT_EQ(said(R"({"model": 5})"), "model: expected a text, found '5'");
  EXPECT_THAT(said(R"({"bugdet": 2700})"), HasSubstr("found 'bugdet'; did you mean 'budget'?"));
}

/// A request in words and as JSON.
struct Right {
  Words words;
  const char* json;
  const char* kept;
};

TEST(FitRequest, KeepsTheSameOfWordsAndOfJson) {
  const std::vector<Right> all{
      {{}, "{}", "{}"},
      {{{"budget", "16K"}, {"fetches", "2"}},
       R"({"fetches": 2, "budget": 16384, "model": null})",
       R"({"budget":16384,"fetches":2})"},
      {{{"budget", "16k"}}, R"({"budget": "16 KiB"})", R"({"budget":16384})"},
      {{{"budget", "1.5K"}}, R"({"budget": 1536})", R"({"budget":1536})"},
      {{{"budget", "64M"}}, R"({"budget": 67108864})", R"({"budget":67108864})"},
      {{{"budget", "auto"}}, R"({"budget": "auto", "search": false})", R"({"budget":"auto"})"},
      {{{"smooth", "1"}}, R"({"smooth": 1})", R"({"smooth":1.0})"},
      {{{"tables", "q=96"}, {"tables", "p=8x8"}},
       R"({"tables": ["q=96", "p=8x8"], "symmetrize": true})",
       R"({"tables":["q=96","p=8x8"]})"},
      {{{"symmetrize", ""}, {"conserve_energy", ""}},
       R"({"conserve_energy": true, "symmetrize": false})",
       R"({"symmetrize":false,"conserve_energy":true})"},
  };
  for (const auto& [words, json, kept] : all) {
    EXPECT_EQ(request_of_words(words).values.dump(), kept);
    EXPECT_EQ(request_of_json(Json::parse(json), FitFront::python).values.dump(), kept);
    EXPECT_EQ(request_of_json(Json::parse(kept), FitFront::python).values.dump(), kept);
  }
}

FitOptions options_of(const char* json, bool isotropic = true) {
  return fit_options(request_of_json(Json::parse(json), FitFront::python), isotropic);
}

TEST(FitRequest, BecomesTheOptionsThatItNames) {
  const FitOptions none = options_of("{}");
  EXPECT_TRUE(std::holds_alternative<DefaultBudget>(*none.form));
  EXPECT_TRUE(none.symmetrize && !none.conserve_energy && !none.samples && !none.smooth && !none.format);
  EXPECT_EQ(none.seed, FitOptions{}.seed);

  const FitOptions budget = options_of(
      R"({"budget": "16K", "fetches": 4, "loss": "relative", "smooth": "auto", "floor": 1e-3, "reweightings": 3,
          "seed": 7, "samples": 100, "format": "float", "symmetrize": false, "conserve_energy": true})");
  const Budget& within = std::get<Budget>(*budget.form);
  EXPECT_EQ(within.bytes, 16384u);
  EXPECT_EQ(within.fetches, 4);
  EXPECT_EQ(within.lobes, std::nullopt);
  EXPECT_EQ(within.loss, FitLoss::relative);
  EXPECT_TRUE(within.scattered.cross_validate && !within.search);
  EXPECT_EQ(within.scattered.floor, 1e-3);
  EXPECT_EQ(within.scattered.reweightings, 3);
  EXPECT_EQ(budget.seed, 7u);
  EXPECT_EQ(budget.samples, 100u);
  EXPECT_EQ(budget.format, TableFormat::single);
  EXPECT_FALSE(budget.symmetrize);
  EXPECT_TRUE(budget.conserve_energy);
  EXPECT_EQ(budget.smooth, std::nullopt);

  const FitOptions searched = options_of(R"({"budget": "auto", "lobes": 3, "search": true, "smooth": 1e-6})");
  EXPECT_EQ(std::get<Budget>(*searched.form).bytes, std::nullopt);
  EXPECT_EQ(std::get<Budget>(*searched.form).lobes, 3);
  EXPECT_TRUE(std::get<Budget>(*searched.form).search);
  EXPECT_EQ(searched.smooth, 1e-6);

  const FitOptions lobe =
      options_of(R"({"model": "pqpr", "tables": ["q=24"], "target": "nodes", "hold_out": "half=1"})");
  EXPECT_EQ(std::get<OneLobe>(*lobe.form).model, "pqpr");
  EXPECT_EQ(std::get<OneLobe>(*lobe.form).tables, std::vector<std::string>{"q=24"});
  EXPECT_EQ(lobe.target, FitTarget::nodes);
  EXPECT_TRUE(lobe.hold_out.has_value());
  EXPECT_EQ(std::get<OneLobe>(*options_of(R"({"tables": ["q=24"]})").form).model, OneLobe{}.model);
  const FitOptions lobes = options_of(R"json({"model": "p(wo) q(h) p(wi) + s(h)"})json");
  EXPECT_TRUE(std::holds_alternative<GivenLobes>(*lobes.form));
  EXPECT_THROW(options_of(R"json({"model": "p(up)"})json"), Error);

  EXPECT_EQ(std::get<BaselineMethod>(*options_of(R"({"method": "svd"})").form).bytes, std::nullopt);
  EXPECT_EQ(std::get<BaselineMethod>(*options_of(R"({"method": "svd", "budget": 400})").form).bytes, 400u);

  FitRequest request = request_of_words(Words{{"book", "a.burnish"}, {"samples", "50"}});
  request.book = std::make_shared<const MaterialBook>();
  EXPECT_EQ(std::get<FromBook>(*fit_options(request, true).form).book, request.book);
}

TEST(FitOptionTable, HoldsTogether) {
  std::vector<std::string> words;
  for (const FitOption& option : fit_option_table()) {
    const std::string name(option.name);
    EXPECT_EQ(&fit_option(name), &option);
    EXPECT_TRUE(option.help.ends_with('.') && option.help.find(". ") == std::string::npos) << name;
    EXPECT_LE(std::ranges::count(option.help, ' ') + 1, 25) << name;
    EXPECT_TRUE(option.standard.empty() || option.left_out.empty()) << name;
    EXPECT_FALSE(option.standard.empty() && option.left_out.empty()) << name;
    EXPECT_EQ(option.takes == FitValue::choice, !option.choices.empty()) << name;
    const std::string word = spelled(option, FitFront::command_line);
    EXPECT_TRUE(word.starts_with("--")) << name;
    EXPECT_THAT(words, ::testing::Not(::testing::Contains(word)));
    words.push_back(word);
    for (const std::string_view other : option.excludes)
      EXPECT_TRUE(excludes(fit_option(other), option)) << name;
    if (!option.needs.empty()) {
      EXPECT_FALSE(excludes(option, fit_option(option.needs))) << name;
    }
    // The example is accepted, together with the option that it needs.
    Words given{{name, std::string(option.example)}};
    if (!option.needs.empty()) given.emplace_back(option.needs, fit_option(option.needs).example);
    EXPECT_EQ(request_of_words(given).values.contains(name), true) << name;
    // The default is accepted too.
    if (!option.standard.empty() && option.takes != FitValue::flag) {
      EXPECT_EQ(error_of_words({{name, std::string(option.standard)}}, FitFront::python), "") << name;
    }
  }
}

TEST(FitOptionTable, HasTheDefaultsOfTheLibrary) {
  const auto standard = [](const char* name) { return std::string(fit_option(name).standard); };
  EXPECT_EQ(std::stod(standard("floor")), LogLinear{}.floor);
  EXPECT_EQ(standard("loss"), to_string(Budget{}.loss));
  EXPECT_EQ(standard("seed"), std::to_string(FitOptions{}.seed));
  EXPECT_EQ(standard("symmetrize"), FitOptions{}.symmetrize ? "true" : "false");
  EXPECT_EQ(standard("conserve_energy"), FitOptions{}.conserve_energy ? "true" : "false");
  EXPECT_EQ(standard("search"), Budget{}.search ? "true" : "false");
  EXPECT_THAT(std::string(fit_option("budget").left_out),
              HasSubstr(std::to_string(BaselineOptions{}.budget)));
  EXPECT_THAT(std::string(fit_option("budget").left_out),
              HasSubstr(fmt::format("{}K", kDefaultBudget / 1024)));
}

TEST(FitOptionTable, IsPrintedWhole) {
  const Json rows = fit_options_json();
  ASSERT_EQ(rows.size(), fit_option_table().size());
  const Json& fetches = rows.at(2);
  EXPECT_EQ(fetches["name"], "fetches");
  EXPECT_EQ(fetches["range"], "from 1 to 256");
  EXPECT_EQ(fetches["needs"], "budget");
  EXPECT_EQ(fetches["excludes"], Json::parse(R"(["method", "lobes", "search"])"));
  for (const Json& row : rows)
    EXPECT_EQ(row["package"].is_null(), row["name"] == "method" || row["name"] == "book");
}

}  // namespace
}  // namespace burnish
