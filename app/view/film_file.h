// The file that a film is written to, through ffmpeg, or the folder of PNGs.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/image.h"
#include "models/files.h"

namespace enc::app {

// Size, rate and form of a film, which follow from the ending of its name.
struct FilmFormat {
  int width = 1280, height = 720;  // px
  int rate = 30;                   // frames for each second of the experiment
  std::string ending{};            // ".mp4"; may be empty
  bool folder = false;             // of PNGs
};
// Throws Error for an ending that no film has. A name without one is a folder; so is any name where ffmpeg is
// not installed.
[[nodiscard]] FilmFormat film_format(const std::string& path);

class FilmFile {
 public:
  virtual ~FilmFile() = default;  // removes a film that was not kept
  virtual void add(const Image& frame) = 0;
  virtual void keep() = 0;  // the film is whole: puts it in its place
};

// Writes to PATH.part until keep(). Throws Error where something is there already and may not be replaced, or
// where ffmpeg fails, as add() and keep() do. `png`: the bytes of an image.
[[nodiscard]] std::unique_ptr<FilmFile> open_film(const std::string& path, const FilmFormat& format,
                                                  models::Existing existing,
                                                  std::function<std::string(const Image&)> png);

}  // namespace enc::app
