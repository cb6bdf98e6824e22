// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/export/exported_files.h>
#include <burnish/file.h>
#include <burnish/math/closest_name.h>

namespace burnish {

namespace {

constexpr std::array<std::string_view, 20> kNames{
    "ktx2",    "dds", "cube", "exr",  "png",     "gltf", "materialx", "usda",  "mdl",  "three",
    "babylon", "rgl", "html", "glsl", "glsl_es", "hlsl", "msl",       "slang", "wgsl", "cpp"};
constexpr auto kFirstLanguage = static_cast<std::size_t>(ExportTarget::glsl);
static_assert(kFirstLanguage + kShaderLanguages.size() == kNames.size());

}  // namespace

std::span<const std::string_view> export_target_names() noexcept {
  return kNames;
}

std::string_view to_string(ExportTarget target) noexcept {
  return kNames[static_cast<std::size_t>(target)];
}

ExportTarget export_target(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) throw Error("export: " + expected_one_of(kNames, name));
  return static_cast<ExportTarget>(found - kNames.begin());
}

std::optional<ShaderLanguage> language_of(ExportTarget target) noexcept {
  const auto i = static_cast<std::size_t>(target);
  if (i < kFirstLanguage) return {};
  return kShaderLanguages[i - kFirstLanguage];
}

std::string export_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'), digit = c >= '0' && c <= '9';
    if (letter || (digit && !name.empty()))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() ? "brdf" : name;
}

bool has_half_products(ExportTarget target) noexcept {
  return language_of(target) && target != ExportTarget::cpp;
}

bool has_sets(ExportTarget target) noexcept {
  return target == ExportTarget::glsl || target == ExportTarget::slang || target == ExportTarget::wgsl;
}

bool has_spaces(ExportTarget target) noexcept {
  return target == ExportTarget::hlsl;
}

bool has_bindings(ExportTarget target) noexcept {
  return has_sets(target) || has_spaces(target);
}

bool shows_environment(ExportTarget target) noexcept {
  return target == ExportTarget::glsl || target == ExportTarget::glsl_es || target == ExportTarget::html;
}

bool is_language(ExportTarget target) noexcept {
  return language_of(target).has_value();
}

std::string names_of(std::span<const ExportTarget> targets) {
  std::string names;
  for (const ExportTarget target : targets)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", to_string(target));
  return names.empty() ? "none" : names;
}

std::string targets_that(bool (*are_so)(ExportTarget target) noexcept) {
  std::vector<std::string_view> names;
  for (const bool languages : {true, false})
    for (std::size_t i = 0; i < kNames.size(); ++i)
      if (const auto target = static_cast<ExportTarget>(i);
          language_of(target).has_value() == languages && are_so(target))
        names.push_back(kNames[i]);
  return listed(names);
}

void write_files(const std::filesystem::path& folder, std::span<const ExportedFile> files) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error::in_file(folder, "a folder", failed.message());
  for (const ExportedFile& file : files) write_then_rename(folder / file.name, file.bytes);
}

}  // namespace burnish
