#include "models/files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using Identity = std::pair<dev_t, ino_t>;  // identifies a file, whatever its name

struct Inputs {
  std::mutex mutex;
  std::set<std::string> all;  // paths; the program may overwrite one once the file is gone
};
Inputs& inputs() {
  static Inputs all;
  return all;
}
Identity identity(const struct stat& s) { return {s.st_dev, s.st_ino}; }

bool is_input(const std::string& path) {
  struct stat s {};
  if (stat(path.c_str(), &s) != 0) return false;
  const std::lock_guard lock(inputs().mutex);
  return std::any_of(inputs().all.begin(), inputs().all.end(), [&](const std::string& input) {
    struct stat there {};
    return stat(input.c_str(), &there) == 0 && identity(there) == identity(s);
  });
}

void refuse_input(const std::string& path) {
  if (is_input(path))
    throw Error(fmt::format("{}: is read by this command; expected another file to write; choose one", path));
}

// A link leads to a path that the user did not name. Links to devices and pipes are allowed, such as
// /dev/stdout.
void refuse_link(const std::string& path) {
  struct stat s {};
  if (lstat(path.c_str(), &s) == 0 && S_ISLNK(s.st_mode))
    throw Error(
        fmt::format("{}: is a link; expected a file, or a name that is free; name the file that it points "
                    "to, or remove it",
                    path));
}

// Renames, unless the new name exists. Not every file system can do that in one step.
int rename_to_free(const std::string& from, const std::string& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return -1;
  struct stat s {};
  if (lstat(to.c_str(), &s) != 0) return std::rename(from.c_str(), to.c_str());
  errno = EEXIST;
  return -1;
}

}  // namespace

void note_input(const std::string& path) {
  std::error_code failed;
  const fs::path whole = fs::canonical(path, failed);
  if (failed || !fs::is_regular_file(whole, failed)) return;
  const std::lock_guard lock(inputs().mutex);
  inputs().all.insert(whole.string());
}

std::string read_file(const std::string& path, std::size_t most, std::string& why) {
  std::error_code none;
  if (fs::is_directory(path, none)) {
    why = "it is a folder";
    return {};
  }
  if (fs::is_character_file(path, none)) {
    why = "it is a device";
    return {};
  }
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    why = errno != 0 ? std::strerror(errno) : "it cannot be read";
    return {};
  }
  note_input(path);
  std::string text;
  std::array<char, 65536> buffer{};
  for (std::size_t n = 0; text.size() <= most && (n = std::fread(buffer.data(), 1, buffer.size(), file)) > 0;)
    text.append(buffer.data(), n);
  if (std::ferror(file) != 0) why = std::strerror(errno);
  if (text.size() > most) why = fmt::format("it is longer than {} MiB", most >> 20U);
  std::fclose(file);
  return why.empty() ? text : std::string();
}

OutFile::OutFile(std::string path, OverwritePolicy existing) : path_(std::move(path)), existing_(existing) {
  struct stat s {};
  const bool there = stat(path_.c_str(), &s) == 0;
  if (there && S_ISDIR(s.st_mode)) fail(EISDIR);
  if (there && !S_ISREG(s.st_mode)) {
    aside_ = path_;
    fd_ = open(aside_.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd_ < 0) fail(errno);
    return;
  }
  aside_ = path_ + ".part";
  refuse_input(path_);
  refuse_input(aside_);
  refuse_link(path_);
  while (!begin()) close();
}

OutFile::~OutFile() {
  if (fd_ < 0) return;
  if (!spared_ && aside_ != path_ && is_ours()) unlink(aside_.c_str());
  close();
}

bool OutFile::is_ours() const {
  struct stat ours {
  }, there{};
  return fstat(fd_, &ours) == 0 && lstat(aside_.c_str(), &there) == 0 && identity(ours) == identity(there);
}

void OutFile::refuse_existing() const {
  struct stat s {};
  if (existing_ == OverwritePolicy::replace || lstat(path_.c_str(), &s) != 0) return;
  throw Error(
      fmt::format("{}: is there already; expected a new file; choose another name, or give --force "
                  "to replace it",
                  path_));
}

// A run locks its output file from the start.
bool OutFile::lock() const { return flock(fd_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK; }

void OutFile::refuse_other_run() {
  close();
  throw Error(
      fmt::format("{}: another run is writing it; expected one at a time; choose another name, or "
                  "wait for its end",
                  path_));
}

bool OutFile::begin() {
  refuse_existing();  // before creating anything
  fd_ = open(aside_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (fd_ < 0 && errno == EEXIST) {
    remove_left_over();
    return false;
  }
  if (fd_ < 0) fail(errno);
  if (!lock()) refuse_other_run();
  if (!is_ours()) return false;
  try {
    refuse_existing();  // the other run may have ended just now
  } catch (const Error&) {
    unlink(aside_.c_str());
    close();
    throw;
  }
  return true;
}

void OutFile::remove_left_over() {
  refuse_link(aside_);
  fd_ = open(aside_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  struct stat s {};
  if (fd_ < 0 && errno == ENOENT) return;
  if (fd_ < 0 || fstat(fd_, &s) != 0) fail(errno);
  if (!S_ISREG(s.st_mode) || s.st_uid != geteuid()) {
    close();
    throw Error(fmt::format(
        "{}: is no file of yours; expected a name that is free; choose another one for {}", aside_, path_));
  }
  if (!lock()) refuse_other_run();
  if (!is_ours()) return;
  if (s.st_size > 0 && existing_ == OverwritePolicy::keep) {
    close();
    throw Error(
        fmt::format("{}: is left of a run that did not end; look at it, then remove it, or give "
                    "--force to write over it",
                    aside_));
  }
  if (unlink(aside_.c_str()) != 0 && errno != ENOENT) fail(errno);
}

void OutFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(fd_, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(n < 0 ? errno : EIO);
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

std::FILE* OutFile::stream() const {
  const int same = fcntl(fd_, F_DUPFD_CLOEXEC, 0);
  std::FILE* stream = same < 0 ? nullptr : fdopen(same, "wb");
  if (stream == nullptr) fail(errno);
  return stream;
}

void OutFile::keep() {
  if (aside_ != path_) {
    const int failed = existing_ == OverwritePolicy::replace ? std::rename(aside_.c_str(), path_.c_str())
                                                             : rename_to_free(aside_, path_);
    if (failed != 0) {
      spared_ = true;
      throw Error(fmt::format("{}: cannot be put in its place: {}; it is whole in {}", path_,
                              std::strerror(errno), aside_));
    }
  }
  spared_ = true;
  if (::close(std::exchange(fd_, -1)) != 0) fail(errno);
}

void OutFile::close() {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

void OutFile::fail(int why) const {
  throw Error(
      fmt::format("{}: cannot be written: {}; choose a file in a folder that exists, is yours and has "
                  "room",
                  path_, std::strerror(why)));
}

void write_file(const std::string& path, std::string_view text, OverwritePolicy existing) {
  OutFile file(path, existing);
  file.write(text);
  file.keep();
}

OutFolder::OutFolder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed)
    throw Error(
        fmt::format("{}: cannot be made ({}); choose a folder that is yours", path, failed.message()));
  fd_ = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd_ >= 0 && flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(fd_);
    throw Error(
        fmt::format("{}: another run is writing there; expected one at a time; choose another folder, "
                    "or wait for its end",
                    path));
  }
}

OutFolder::~OutFolder() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace enc::models
