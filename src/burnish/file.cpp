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

void write_then_rename(const fs::path& given, std::string_view bytes) {
  std::error_code ignored_state;
  // A link's target is what is replaced; devices, pipes and folders are not.
  const fs::path path =
      fs::is_symlink(given, ignored_state) ? fs::weakly_canonical(given, ignored_state) : given;
  const fs::file_status status = fs::status(path, ignored_state);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error::in_file(given.string(), "a path to write a file to", "something else than a file");
  const fs::path temporary = path.string() + fmt::format(".{}.partial", ::getpid());
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
      std::error_code ignored;
      fs::remove(temporary, ignored);
      throw Error::in_file(given.string(), "a writable path", "a write error");
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
