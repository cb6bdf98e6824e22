// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <nlohmann/json.hpp>

#include <burnish/book/book_file.h>
#include <burnish/library/fit_settings.h>
#include <burnish/library/sha256.h>

namespace burnish {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json json_of(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json json_of(const LogLinear& how) {
  return {{"cross_validate", how.cross_validate},
          {"reweightings", json_of(how.reweightings)},
          {"floor", how.floor}};
}

Json json_of(const OneLobe& form) {
  return {{"model", form.model}, {"tables", form.tables}, {"how", json_of(form.how)}};
}

// Digests of earlier batches hold this text: a number that is left to the library is 0 in it, and the fetches of a
// DefaultBudget are null.
Json json_of(const Budget& form) {
  return {{"bytes", json_of(form.bytes)},    {"fetches", form.fetches.value_or(0)},
          {"lobes", form.lobes.value_or(0)}, {"search", form.search},
          {"loss", to_string(form.loss)},    {"scattered", json_of(form.scattered)}};
}

Json json_of(const DefaultBudget& form) {
  Json json = json_of(Budget{.bytes = kDefaultBudget, .loss = form.loss, .scattered = form.scattered});
  json["fetches"] = nullptr;
  return json;
}

Json json_of(const GivenLobes& form) {
  return {{"lobes", form.model}, {"tables", form.tables}, {"loss", to_string(form.loss)}};
}

Json json_of(const BaselineMethod& form) {
  return {{"method", form.method}, {"bytes", form.bytes.value_or(0)}};
}

Json json_of(const FromBook& form) {
  return {{"book", sha256(format_book(*form.book))}};
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string settings_text(const FitOptions& options) {
  Json json{{"form", nullptr}, {"target", nullptr}};
  if (options.target) json["target"] = to_string(*options.target);
  if (options.form) json["form"] = std::visit([](const auto& form) { return json_of(form); }, *options.form);
  if (options.hold_out)
    json["hold_out"] = {static_cast<int>(options.hold_out->kind), options.hold_out->number};
  json["smooth"] = json_of(options.smooth);
  if (options.format) json["format"] = to_string(*options.format);
  json["samples"] = options.samples.value_or(0);
  json["seed"] = options.seed;
  json["symmetrize"] = options.symmetrize;
  json["conserve_energy"] = options.conserve_energy;
  json["score"] = options.score;
  return text_of(json);
}

std::string settings_text(const OpenOptions& options) {
  Json json{{"spectral", options.keep_spectral},
            {"illuminant", options.illuminant},
            {"has_cosine", options.has_cosine},
            {"clamp_negatives", options.clamp_negatives},
            {"back", options.back_side},
            {"has_cosine_o", options.has_cosine_o},
            {"brf", options.brf}};
  // named where they are set alone, so that the settings of earlier fits stay what they were
  if (options.part) json["part"] = to_string(*options.part);
  if (!options.band.empty()) json["band"] = options.band;
  if (options.scale_to_tis) json["scale_to_tis"] = true;
  return text_of(json);
}

std::string settings_text(const ExportOptions& options) {
  Json to = Json::array();
  for (const ExportTarget target : options.to) to.push_back(to_string(target));
  return text_of(
      Json{{"to", to}, {"exact", options.exact}, {"mips", options.mips}, {"compressed", options.compressed}});
}

std::string library_version() {
  return BURNISH_VERSION;
}

}  // namespace burnish
