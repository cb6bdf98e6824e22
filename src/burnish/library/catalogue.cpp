// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <burnish/embedded_file.h>
#include <burnish/error.h>
#include <burnish/export/web.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/image/png.h>
#include <burnish/library/catalogue.h>
#include <burnish/library/folder_file.h>

namespace burnish {

namespace fs = std::filesystem;

// The files of web/catalogue.
std::span<const EmbeddedFile> catalogue_files();

namespace {

using Json = nlohmann::ordered_json;

constexpr int kSheetColumns = 8, kSheetRows = 8;
constexpr std::size_t kPerSheet = kSheetColumns * kSheetRows, kPerPart = 32;
constexpr std::size_t kLongestLink = 1'000'000;  // digits; the studio reads 2^20 characters

void write_and_rename(const fs::path& path, std::string_view bytes) {
  const fs::path temporary = path.string() + fmt::format(".{}.partial", ::getpid());
  write_durably(temporary, bytes);
  rename_durably(temporary, path);
}

std::string script(std::string_view function, const Json& value) {
  return fmt::format("{}({});\n", function, value.dump(-1, ' ', true, Json::error_handler_t::replace));
}

// In the digits of a link: RFC 4648, section 5, without padding.
std::string base64url(std::string_view bytes) {
  std::string text = base64(std::as_bytes(std::span(bytes)));
  std::ranges::replace(text, '+', '-');
  std::ranges::replace(text, '/', '_');
  text.resize(text.find_last_not_of('=') + 1);
  return text;
}

// Returns the part of a model that a link carries; empty where it cannot.
std::string link_of(const fs::path& folder, const MaterialRecord& record) {
  const fs::path path = folder / record.files.front().path;
  if (path.extension() == ".json") return {};
  const FileBytes file = read_file(path);
  std::string text = base64url(path.extension() == ".burnish" ? std::string(file.text())
                                                              : format_compact(parse_model(file)));
  return text.size() > kLongestLink ? std::string() : text;
}

// Pictures beside each other, rows from the top.
Image8 sheet(const fs::path& folder, std::span<const MaterialRecord> records) {
  Image8 all;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Image8 one = read_png(folder / records[k].files.at(1).path);
    if (k == 0) {
      const auto rows = static_cast<int>((records.size() + kSheetColumns - 1) / kSheetColumns);
      all = Image8(one.width * kSheetColumns, one.height * rows, 4);
    }
    const int left = static_cast<int>(k) % kSheetColumns * one.width,
              top = static_cast<int>(k) / kSheetColumns * one.height;
    for (int y = 0; y < one.height; ++y)
      for (int x = 0; x < one.width; ++x) {
        const auto to = all.at(left + x, top + y);
        std::ranges::copy(one.at(x, y), to.begin());
        if (one.channels == 3) to[3] = 255;
      }
  }
  return all;
}

Json row_of(const MaterialRecord& record, bool linked) {
  Json row{{"name", record.name},
           {"path", record.argument},
           {"file", record.files.front().path},
           {"format", record.format},
           {"model", record.model},
           {"bytes", record.bytes},
           {"fetches", record.fetches ? Json(*record.fetches) : Json()}};
  for (const auto& [figure, value] : kRecordFigures)
    row[figure] = record.*value ? Json(*(record.*value)) : Json();
  row.update({{"seconds", record.seconds}, {"warnings", record.warnings}, {"linked", linked}});
  return row;
}

}  // namespace

std::vector<std::string> write_catalogue(const fs::path& folder, std::span<const MaterialRecord> records,
                                         const std::string& studio) {
  make_folder(folder / "page");
  std::vector<std::string> written;
  const auto write = [&](std::string path, std::string_view bytes) {
    write_and_rename(folder / path, bytes);
    written.push_back(std::move(path));
  };
  std::vector<MaterialRecord> fitted;
  Json failed = Json::array();
  for (const MaterialRecord& record : records)
    if (record.fitted())
      fitted.push_back(record);
    else
      failed.push_back({{"name", record.name}, {"path", record.argument}, {"reason", record.reason}});
  const std::span<const MaterialRecord> all(fitted);
  const auto part_of = [&](std::size_t begin, std::size_t size) {
    return all.subspan(begin, std::min(size, all.size() - begin));
  };

  // pictures
  for (std::size_t begin = 0; begin < all.size(); begin += kPerSheet)
    write(fmt::format("page/pictures-{}.png", begin / kPerSheet),
          encode_png(sheet(folder, part_of(begin, kPerSheet))));

  // models
  Json rows = Json::array();
  for (std::size_t begin = 0; begin < all.size(); begin += kPerPart) {
    Json links = Json::array();
    for (const MaterialRecord& record : part_of(begin, kPerPart)) {
      links.push_back(link_of(folder, record));
      rows.push_back(row_of(record, !links.back().get_ref<const std::string&>().empty()));
    }
    write(fmt::format("page/models-{}.js", begin / kPerPart),
          script("catalogueModels", {{"part", begin / kPerPart}, {"links", std::move(links)}}));
  }

  // figures, and the page last: what it names is there
  write("page/materials.js", script("catalogueMaterials", {{"studio", studio},
                                                           {"perSheet", kPerSheet},
                                                           {"columns", kSheetColumns},
                                                           {"perPart", kPerPart},
                                                           {"materials", std::move(rows)},
                                                           {"failed", std::move(failed)}}));
  for (const EmbeddedFile& file : catalogue_files())
    if (file.name != kCataloguePage) write(fmt::format("page/{}", file.name), file.text);
  write(std::string(kCataloguePage), text_of(catalogue_files(), kCataloguePage));
  return written;
}

}  // namespace burnish
