// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <burnish/error.h>
#include <burnish/library/folder_file.h>

namespace burnish {

namespace fs = std::filesystem;

namespace {

Error cannot_write(const fs::path& path, int code) {
  return Error::in_file(path.string(), "a path that can be written", std::strerror(code));
}

// All bytes, however many calls that takes. Returns 0 or what errno says.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ::ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// Writes to the opened file and closes it in any case; the file is removed where it cannot be written.
void write_and_close(int descriptor, const fs::path& path, std::string_view bytes) {
  int code = write_all(descriptor, bytes);
  if (code == 0 && ::fdatasync(descriptor) != 0) code = errno;
  if (::close(descriptor) != 0 && code == 0) code = errno;
  if (code == 0) return;
  ::unlink(path.c_str());
  throw cannot_write(path, code);
}

}  // namespace

void write_durably(const fs::path& path, std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw cannot_write(path, errno);
  write_and_close(descriptor, path, bytes);
}

bool write_new_durably(const fs::path& path, std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0 && errno == EEXIST) return false;
  if (descriptor < 0) throw cannot_write(path, errno);
  write_and_close(descriptor, path, bytes);
  return true;
}

void rename_durably(const fs::path& from, const fs::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw cannot_write(to, errno);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error::in_file(folder.string(), "a folder that can be made", error.message());
}

GrowingFile::GrowingFile(fs::path path)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw cannot_write(path_, errno);
}

GrowingFile::~GrowingFile() {
  ::close(descriptor_);
}

void GrowingFile::append(std::string_view line) {
  int code = write_all(descriptor_, line);
  if (code == 0 && ::fdatasync(descriptor_) != 0) code = errno;
  // a folder that was removed takes the line and loses it
  if (code == 0 && ::access(path_.c_str(), F_OK) != 0) code = errno;
  if (code != 0) throw cannot_write(path_, code);
}

}  // namespace burnish
