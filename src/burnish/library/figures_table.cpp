// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/ranges.h>
#include <sqlite3.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/library/figures_table.h>
#include <burnish/library/folder_file.h>

namespace burnish {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSchema =
    "CREATE TABLE materials (name TEXT PRIMARY KEY, path TEXT NOT NULL, file TEXT, format TEXT, model TEXT,"
    " bytes INTEGER, fetches INTEGER, psnr REAL, ssim REAL, relative REAL, rms_log REAL, log_cos REAL,"
    " albedo REAL, warnings TEXT, reason TEXT, seconds REAL NOT NULL, key TEXT NOT NULL) WITHOUT ROWID";
constexpr const char* kInsert = "INSERT INTO materials VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";

struct CloseDatabase {
  void operator()(sqlite3* database) const noexcept { sqlite3_close(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;
using Statement = std::unique_ptr<sqlite3_stmt, FinalizeStatement>;

void check(int code, sqlite3* database) {
  if (code != SQLITE_OK && code != SQLITE_DONE)
    throw Error(fmt::format("SQLite: {}", sqlite3_errmsg(database)));
}

/// Binds the values of a row one after the other.
class Row {
 public:
  explicit Row(sqlite3_stmt* statement) : statement_(statement) {}
  Row& text(const std::string& value) {
    sqlite3_bind_text(statement_, ++place_, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Row& text_or_null(const std::string& value) { return value.empty() ? null() : text(value); }
  Row& integer(std::uint64_t value) {
    sqlite3_bind_int64(statement_, ++place_, static_cast<sqlite3_int64>(value));
    return *this;
  }
  Row& real(const std::optional<double>& value) {
    if (!value) return null();
    sqlite3_bind_double(statement_, ++place_, *value);
    return *this;
  }
  Row& null() {
    sqlite3_bind_null(statement_, ++place_);
    return *this;
  }

 private:
  sqlite3_stmt* statement_;
  int place_ = 0;
};

void bind(sqlite3_stmt* statement, const MaterialRecord& record) {
  Row row(statement);
  row.text(record.name).text(record.argument);
  if (record.files.empty())
    row.null();
  else
    row.text(record.files.front().path);
  row.text_or_null(record.format).text_or_null(record.model);
  if (record.fitted())
    row.integer(record.bytes);
  else
    row.null();
  if (record.fetches)
    row.integer(*record.fetches);
  else
    row.null();
  for (const auto& [figure, value] : kRecordFigures) row.real(record.*value);
  row.text_or_null(fmt::format("{}", fmt::join(record.warnings, "; ")));
  row.text_or_null(record.reason).real(record.seconds).text(record.key);
}

// The database as the bytes of its file.
std::string database_of(std::span<const MaterialRecord> records) {
  sqlite3* opened = nullptr;
  const int code = sqlite3_open(":memory:", &opened);
  const Database database(opened);
  check(code, opened);
  check(sqlite3_exec(opened, kSchema, nullptr, nullptr, nullptr), opened);
  check(sqlite3_exec(opened, "BEGIN", nullptr, nullptr, nullptr), opened);
  sqlite3_stmt* prepared = nullptr;
  check(sqlite3_prepare_v2(opened, kInsert, -1, &prepared, nullptr), opened);
  const Statement statement(prepared);
  for (const MaterialRecord& record : records) {
    bind(prepared, record);
    check(sqlite3_step(prepared), opened);
    check(sqlite3_reset(prepared), opened);
  }
  check(sqlite3_exec(opened, "COMMIT", nullptr, nullptr, nullptr), opened);
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, decltype(&sqlite3_free)> bytes(
      sqlite3_serialize(opened, "main", &size, 0), &sqlite3_free);
  if (!bytes) throw Error("SQLite: expected enough memory, found too little");
  return {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)};
}

}  // namespace

void write_figures_table(const fs::path& folder, std::span<const MaterialRecord> records) {
  const fs::path path = folder / kFiguresTable,
                 temporary = path.string() + fmt::format(".{}.partial", ::getpid());
  write_durably(temporary, database_of(records));
  rename_durably(temporary, path);
}

}  // namespace burnish
