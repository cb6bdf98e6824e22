// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/open_source.h>
#include <burnish/io/text_reader.h>
#include <burnish/library/entries.h>
#include <burnish/reflectance/analytic.h>

namespace burnish {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kLongestList = std::uint64_t{64} << 20;  // bytes
constexpr std::size_t kLongestName = 80;
constexpr std::array<std::string_view, 4> kAddresses = {"np:", "nbrdf:", "book:", "surface:"};

bool is_letter_or_digit(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

// A name made of a text's own characters, those that serve.
std::string safe_name(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool kept = is_letter_or_digit(c) || (!name.empty() && (c == '.' || c == '-'));
    if (kept)
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  name.resize(std::min(name.size(), kLongestName));
  while (!name.empty() && !is_letter_or_digit(name.back())) name.pop_back();
  return name.empty() ? "material" : name;
}

// Returns the text behind the # of nbrdf:FILE#NAME, an analytic BRDF, or a file's name without its ending.
std::string name_of(const std::string& argument) {
  if (is_analytic_spec(argument)) return safe_name(argument);
  const bool has_address =
      std::ranges::any_of(kAddresses, [&](std::string_view prefix) { return argument.starts_with(prefix); });
  if (const std::size_t mark = argument.rfind('#'); has_address && mark + 1 < argument.size())
    return safe_name(std::string_view(argument).substr(mark + 1));
  return safe_name(fs::path(argument).stem().string());
}

// Names beside their arguments, made different where they meet.
std::vector<LibraryEntry> told_apart(std::vector<LibraryEntry> entries) {
  std::set<std::string> taken;
  for (LibraryEntry& entry : entries) {
    const std::string name = entry.name;
    for (int k = 2; !taken.insert(entry.name).second; ++k) entry.name = fmt::format("{}-{}", name, k);
  }
  return entries;
}

// Returns true if a batch worked in the folder: it has models, and lines about them.
bool is_library(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder / "models", error)) return false;
  for (auto file = fs::directory_iterator(folder / "journal", error);
       !error && file != fs::directory_iterator(); file.increment(error))
    if (file->path().extension() == ".jsonl") return true;
  return false;
}

bool is_one_of(const fs::path& path, const std::vector<fs::path>& others) {
  return std::ranges::any_of(others, [&](const fs::path& other) {
    std::error_code error;  // of what is not there
    return !other.empty() && fs::equivalent(path, other, error);
  });
}

// Returns true if a file of a folder is meant as a material: by a name that nothing else has, or by its content.
bool is_material(const fs::path& path) {
  constexpr std::array<std::string_view, 8> kEndings = {
      ".binary", ".bsdf", ".brdf", ".mbsdf", ".astm", ".xompt", ".anisotropicbsdf", ".burnish"};
  constexpr std::uintmax_t kLargest = std::uintmax_t{1} << 28;  // bytes that are read to be known
  if (std::ranges::find(kEndings, lower_case(path.extension().string())) != kEndings.end()) return true;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > kLargest) return true;  // the reader says what is wrong
  return size > 0 && looks_like_source(read_file(path));
}

std::vector<LibraryEntry> entries_of_folder(const fs::path& folder, const std::vector<fs::path>& others,
                                            std::vector<std::string>* skipped_files) {
  if (is_one_of(folder, others) || is_library(folder))
    throw Error::in_file(folder.string(), "a folder with measurements", "the folder of a batch's results");
  std::vector<fs::path> files;
  try {
    for (auto at = fs::recursive_directory_iterator(folder, fs::directory_options::follow_directory_symlink);
         at != fs::recursive_directory_iterator(); ++at) {
      const fs::path& path = at->path();
      const bool skipped = path.filename().string().starts_with('.') || is_one_of(path, others) ||
                           (at->is_directory() && is_library(path));
      if (skipped && at->is_directory()) at.disable_recursion_pending();
      if (!skipped && at->is_regular_file()) files.push_back(path);
    }
  } catch (const fs::filesystem_error& error) {
    throw Error::in_file(folder.string(), "a folder that can be read", error.code().message());
  }
  if (files.empty()) throw Error::in_file(folder.string(), "a folder with files", "none");
  std::ranges::sort(files);
  std::vector<std::string> skipped;
  std::erase_if(files, [&](const fs::path& file) {
    if (is_material(file)) return false;
    skipped.push_back(file.string());
    return true;
  });
  if (files.empty())
    throw Error::in_file(folder.string(), "a folder with measurements",
                         fmt::format("{} other files", skipped.size()));
  if (skipped_files) *skipped_files = std::move(skipped);
  std::vector<LibraryEntry> entries;
  for (const fs::path& file : files)
    entries.push_back(
        {safe_name(file.lexically_relative(folder).replace_extension().string()), file.string()});
  return told_apart(std::move(entries));
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    lines.emplace_back(line.substr(first, line.find_last_not_of(" \t\r") + 1 - first));
  }
  return lines;
}

}  // namespace

std::vector<LibraryEntry> named_entries(const std::vector<std::string>& arguments) {
  std::vector<LibraryEntry> entries;
  for (const std::string& argument : arguments) entries.push_back({name_of(argument), argument});
  return told_apart(std::move(entries));
}

std::vector<LibraryEntry> library_entries(const fs::path& list_or_folder, const std::vector<fs::path>& others,
                                          std::vector<std::string>* skipped) {
  std::error_code error;
  if (fs::is_directory(list_or_folder, error)) return entries_of_folder(list_or_folder, others, skipped);
  const FileBytes list = read_file(list_or_folder, kLongestList);
  if (const std::size_t zero = list.text().find('\0'); zero != std::string_view::npos)
    throw Error(list.name, zero, "a folder, or a list with an argument a line", "a byte 0");
  const std::vector<std::string> arguments = lines_of(list.text());
  if (arguments.empty()) throw Error::in_file(list.name, "a list with an argument a line", "no argument");
  return named_entries(arguments);
}

}  // namespace burnish
