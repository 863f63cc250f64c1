#include "app/view/encoder.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

extern char** environ;  // NOLINT: POSIX has it

namespace enc::app {

std::string ffmpeg_path() {
  const char* path = std::getenv("PATH");
  const std::string folders = path == nullptr ? "/usr/local/bin:/usr/bin" : path;
  for (std::size_t at = 0; at <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    const std::filesystem::path file = std::filesystem::path(folders.substr(at, end - at)) / "ffmpeg";
    std::error_code none;
    if (std::filesystem::is_regular_file(file, none) && access(file.c_str(), X_OK) == 0) return file.string();
    at = end + 1;
  }
  return {};
}

Encoder::Encoder(const std::string& ffmpeg, int width, int height, int rate,
                 const std::vector<std::string>& format, const std::string& file)
    : file_(file) {
  std::vector<std::string> words{
      ffmpeg, "-nostdin",           "-hide_banner", "-loglevel", "error", "-y",
      "-f",   "rawvideo",           "-pix_fmt",     "rgb24",     "-s",    fmt::format("{}x{}", width, height),
      "-r",   std::to_string(rate), "-i",           "-"};
  words.insert(words.end(), format.begin(), format.end());
  words.push_back("file:" + file);  // a colon in the name is no protocol
  std::array<int, 2> ends{-1, -1};
  messages_ = memfd_create("messages", MFD_CLOEXEC);  // of any length: a full pipe would stop ffmpeg
  if (messages_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(fmt::format("ffmpeg cannot be started: {}", std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, messages_, 2);
  // A group of its own: Ctrl-C reaches this process alone, which then ends the film.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failed = posix_spawn(&pid_, ffmpeg.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  frames_ = ends[1];
  if (failed == 0) return;
  ::close(frames_);
  ::close(messages_);
  throw Error(fmt::format("{} cannot be started: {}", ffmpeg, std::strerror(failed)));
}

Encoder::~Encoder() {
  if (pid_ > 0) kill(pid_, SIGKILL);
  wait();
  ::close(messages_);
}

void Encoder::add(const Image& frame) {
  const std::uint8_t* from = frame.rgb.data();
  for (std::size_t left = frame.rgb.size(); left > 0;) {
    const ssize_t n = ::write(frames_, from, left);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail();
    from += n;
    left -= static_cast<std::size_t>(n);
  }
}

void Encoder::finish() {
  wait();
  if (status_ != 0) fail();
}

// Closes the pipe, which is the end of the film.
void Encoder::wait() {
  if (frames_ >= 0) ::close(std::exchange(frames_, -1));
  if (pid_ <= 0) return;
  while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
}

void Encoder::fail() {
  wait();
  std::array<char, 512> text{};
  const ssize_t n = pread(messages_, text.data(), text.size() - 1, 0);
  std::string line(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  line.resize(std::min(line.find('\n'), line.size()));
  if (line.empty())
    line = WIFSIGNALED(status_) ? fmt::format("ended by signal {}", WTERMSIG(status_))
                                : fmt::format("exit code {}", WEXITSTATUS(status_));
  throw Error(
      fmt::format("{}: ffmpeg failed: {}; choose another ending, or a name without one for a folder of PNGs",
                  file_, line));
}

}  // namespace enc::app
