// The output of a film: a file written through ffmpeg, or a folder of PNGs.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/image.h"
#include "models/files.h"

namespace enc::app {

// Size, rate and form of a film, determined by the ending of its name.
struct FilmFormat {
  int width = 1280, height = 720;  // px
  int rate = 30;                   // frames for each second of the experiment
  std::string ending{};            // ".mp4"; may be empty
  bool folder = false;             // a folder of PNGs
};
// Throws Error for an unknown ending. A name without an ending is a folder; without ffmpeg, any name is one.
[[nodiscard]] FilmFormat film_format(const std::string& path);

class FilmFile {
 public:
  virtual ~FilmFile() = default;  // removes a film that was not kept
  virtual void add(const Image& frame) = 0;
  virtual void keep() = 0;  // the film is complete: moves it to its place
};

// Writes to PATH.part until keep(). Throws Error if a file exists there and may not be replaced, or if ffmpeg
// fails, as add() and keep() do. `png`: the bytes of an image.
[[nodiscard]] std::unique_ptr<FilmFile> open_film(const std::string& path, const FilmFormat& format,
                                                  models::OverwritePolicy existing,
                                                  std::function<std::string(const Image&)> png);

}  // namespace enc::app
