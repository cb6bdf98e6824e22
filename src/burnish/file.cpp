// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/file.h>

namespace burnish {

namespace fs = std::filesystem;

FileBytes read_file(const fs::path& path, std::uint64_t limit) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error || !fs::exists(status)) throw Error::in_file(path.string(), "a readable file", "no such file");
  if (!fs::is_regular_file(status)) throw Error::in_file(path.string(), "a regular file", "something else");
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw Error::in_file(path.string(), "a readable file", error.message());
  if (size == 0) throw Error(path.string(), 0, "data", "an empty file");
  if (size > limit)
    throw Error::in_file(path.string(), fmt::format("at most {} bytes", limit),
                         fmt::format("{} bytes", size));

  FileBytes file{path.string(), std::vector<std::byte>(size)};
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(file.bytes.data()), static_cast<std::streamsize>(size));
  if (!in) throw Error::in_file(path.string(), "a readable file", "a read error");
  return file;
}

namespace {

// Returns the file to replace, in a folder that takes files: a link's target; no devices, pipes and folders.
fs::path replaced_file(const fs::path& given) {
  std::error_code ignored;
  const fs::path path = fs::is_symlink(given, ignored) ? fs::weakly_canonical(given, ignored) : given;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error::in_file(given.string(), "a path to write a file to", "something else than a file");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw Error::in_file(given.string(), "a path in a folder that is there",
                         fmt::format("no folder '{}'", folder.string()));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error::in_file(given.string(), "a path in a folder that can be written",
                         std::generic_category().message(errno));
  return path;
}

}  // namespace

void check_writable(const fs::path& path) {
  replaced_file(path);
}

void write_then_rename(const fs::path& given, std::string_view bytes) {
  const fs::path path = replaced_file(given);
  const fs::path temporary = path.string() + fmt::format(".{}.partial", ::getpid());
  {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (out) out.close();  // writes what is left
    if (!out) {
      const int reason = errno;
      out.close();
      std::error_code ignored;
      fs::remove(temporary, ignored);
      throw Error::in_file(
          given.string(), "a writable path",
          reason == 0 ? "a write error" : "a write error: " + std::generic_category().message(reason));
    }
  }
  std::error_code error;
  fs::rename(temporary, path, error);
  if (error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw Error::in_file(path.string(), "a writable path", error.message());
  }
}

}  // namespace burnish
