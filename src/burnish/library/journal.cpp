// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/library/journal.h>

namespace burnish {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Journal::Journal(const fs::path& folder, const std::string& writer)
    : folder_(folder / "journal"), own_(folder_ / (writer + ".jsonl")) {
  make_folder(folder_);
  refresh();
}

std::optional<MaterialRecord> Journal::record(const std::string& name, const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = records_.find({name, key});
  return found == records_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::vector<AssembledFile>> Journal::assembled(const std::string& digest) const {
  const std::lock_guard lock(mutex_);
  const auto found = assembled_.find(digest);
  return found == assembled_.end() ? std::nullopt : std::optional(found->second);
}

bool Journal::empty() const {
  const std::lock_guard lock(mutex_);
  return empty_;
}

void Journal::refresh() {
  const std::lock_guard lock(mutex_);
  try {
    for (const auto& file : fs::directory_iterator(folder_))
      if (file.path() != own_ && file.path().extension() == ".jsonl") read_lines(file.path());
  } catch (const fs::filesystem_error& error) {
    throw Error::in_file(folder_.string(), "a folder that can be read", error.code().message());
  }
}

// Takes the whole lines that are new.
void Journal::read_lines(const fs::path& file) {
  std::uint64_t& taken = read_[file.filename().string()];
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(taken));
  std::string line;
  while (std::getline(in, line) && !in.eof()) {
    taken += line.size() + 1;
    take(line);
  }
}

void Journal::take(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return;
  empty_ = false;
  const std::string event = json.value("event", "");
  if (event == "assembled") take_assembled(json);
  if (event != "fitted" && event != "failed") return;
  try {
    MaterialRecord record = parse_material_record(line);
    const auto [at, is_new] = records_.try_emplace({record.name, record.key}, record);
    if (!is_new && (record.fitted() || !at->second.fitted())) at->second = std::move(record);
  } catch (const Error&) {  // not written whole
  }
}

// One of an earlier version names no files, and counts as not written.
void Journal::take_assembled(const nlohmann::ordered_json& json) {
  try {
    std::vector<AssembledFile> files;
    for (const Json& file : json.at("files")) files.push_back({file.at("path"), file.at("sha256")});
    assembled_[json.at("of")] = std::move(files);
  } catch (const Json::exception&) {
  }
}

void Journal::write(const std::string& json) {
  const std::lock_guard lock(mutex_);
  // after half a line nothing can be added, since it would be of that line
  if (broken_) throw Error::in_file(own_.string(), "a journal that takes lines", "one that failed to");
  broken_ = true;
  if (!file_) file_ = std::make_unique<GrowingFile>(own_);
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  file_->append(fmt::format("{},\"at\":{:.3f}}}\n", json.substr(0, json.size() - 1), now.count()));
  broken_ = false;
  take(json);
}

void Journal::append_began(const std::string& name, const std::string& key) {
  write(Json{{"event", "began"}, {"name", name}, {"key", key}}.dump());
}

void Journal::append(const MaterialRecord& record) {
  const std::string json = to_json(record);
  write((record.fitted() ? R"({"event":"fitted",)" : R"({"event":"failed",)") + json.substr(1));
}

void Journal::append_assembled(const std::string& digest, const std::vector<AssembledFile>& files) {
  Json json{{"event", "assembled"}, {"of", digest}, {"files", Json::array()}};
  for (const AssembledFile& file : files)
    json["files"].push_back({{"path", file.path}, {"sha256", file.sha256}});
  write(json.dump());
}

}  // namespace burnish
