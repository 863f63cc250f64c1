// ffmpeg as a child process that reads raw frames from a pipe and writes them as a film.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

#include "core/base/image.h"

namespace enc::app {

// Full path of ffmpeg in PATH; empty: it is not installed.
[[nodiscard]] std::string ffmpeg_path();

class Encoder {
 public:
  // Frames are `width` x `height` pixels, `rate` a second. `format`: ffmpeg's options for the output, such as
  // {"-f", "mp4"}. Throws Error if ffmpeg cannot be started.
  Encoder(const std::string& ffmpeg, int width, int height, int rate, const std::vector<std::string>& format,
          const std::string& file);
  // Kills ffmpeg unless finish() has returned.
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // Both throw Error with ffmpeg's first message if it failed.
  void add(const Image& frame);
  void finish();  // waits until the film is written

 private:
  void wait();
  [[noreturn]] void fail();

  std::string file_;
  pid_t pid_ = -1;
  int frames_ = -1, messages_ = -1;  // the pipe, and a memory file with ffmpeg's standard error
  int status_ = 0;
};

}  // namespace enc::app
